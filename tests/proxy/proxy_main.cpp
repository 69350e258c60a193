// pmesh_proxy: the seeded proxy as a program. Says where it listens on stderr; ends on SIGINT or
// SIGTERM and then prints what it did as one JSON object.
#include <csignal>
#include <cstdio>
#include <system_error>

#include <CLI/CLI.hpp>

#include "tests/proxy/proxy.h"

namespace {

using namespace pmesh::test;

std::chrono::microseconds from_milliseconds(double milliseconds) {
  return std::chrono::microseconds(static_cast<std::int64_t>(milliseconds * 1000));
}

void add_options(CLI::App& app, ProxyOptions& options) {
  app.add_option("upstream", options.upstream_port, "Port on 127.0.0.1 to pass everything to")
      ->required();
  app.add_option("--port", options.port, "Port on 127.0.0.1 to listen on; 0 is any free one");
  app.add_option("--seed", options.seed, "Of all random choices")->capture_default_str();
  app.add_option("--down", options.link.bits_per_second_down, "Bits per second to the client");
  app.add_option("--up", options.link.bits_per_second_up, "Bits per second to the upstream");
  app.add_option_function<double>(
      "--delay", [&](double ms) { options.link.delay = from_milliseconds(ms); },
      "One way, in milliseconds");
  app.add_option("--segment", options.link.segment_bytes, "Bytes passed on at a time, at most")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--stall-probability", options.link.stall_probability, "Of a segment");
  app.add_option_function<double>(
      "--stall", [&](double ms) { options.link.stall = from_milliseconds(ms); },
      "How long a stalled segment is late, in milliseconds");
  app.add_option("--reset-probability", options.reset_probability, "Of a connection");
  app.add_option("--reset-bytes", options.reset_bytes, "Within how many bytes to the client")
      ->capture_default_str();
  app.add_flag("--http", options.is_http, "Meddle with HTTP by the options below");
  app.add_option("--short-probability", options.short_body_probability, "Of a short body");
  app.add_option("--short-bytes", options.short_bytes, "Within how many bytes of the body")
      ->capture_default_str();
  app.add_option("--whole-probability", options.drop_range_probability,
                 "Of a 200 where a range was asked");
  app.add_option("--bad-gateway-probability", options.bad_gateway_probability, "Of an answer 502");
}

}  // namespace

int main(int argc, char** argv) {
  ProxyOptions options;
  CLI::App app("A slow, late and broken network on the loopback, by a seed");
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);

  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // before the proxy's thread begins
  try {
    const SeededProxy proxy(options);
    std::fprintf(stderr, "listening on 127.0.0.1:%d\n", static_cast<int>(proxy.port()));
    int signal = 0;
    sigwait(&signals, &signal);
    std::printf("%s\n", to_json(proxy.counts()).c_str());
  } catch (const std::system_error& error) {
    std::fprintf(stderr, "pmesh_proxy: %s\n", error.what());
    return 1;
  }
  return 0;
}
