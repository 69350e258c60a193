// serve_load hold|ask: the load of bench/serve that wrk cannot make. One thread.
#include "bench/serve/load.h"

#include <fstream>
#include <iterator>
#include <map>

#include <CLI/CLI.hpp>

namespace {

using namespace pmesh::bench;

/// `length` bytes of the file from `offset` on.
std::string read_part(const std::string& path, std::uint64_t offset, std::uint64_t length) {
  std::string bytes(length, '\0');
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(bytes.data(), static_cast<std::streamsize>(length));
  if (!in) throw CLI::ValidationError("--file", path + " has no such bytes");
  return bytes;
}

void add_target(CLI::App& verb, Target& target) {
  verb.add_option("--port", target.port, "Of the server on 127.0.0.1")->required();
  verb.add_option("--connections", target.connections)->capture_default_str();
  verb.add_option("--addresses", target.addresses, "The connections come from so many")
      ->capture_default_str();
  verb.add_option("--first-address", target.first_address, "Number of the first")
      ->capture_default_str();
  verb.add_option("--path", target.path, "What is asked for")->capture_default_str();
}

void add_hold(CLI::App& app, HoldOptions& options) {
  const std::map<std::string, HoldOptions::Kind> kinds = {{"idle", HoldOptions::Kind::idle},
                                                          {"stall", HoldOptions::Kind::stall},
                                                          {"drip", HoldOptions::Kind::drip}};
  CLI::App* verb = app.add_subcommand("hold", "Hold connections that do no work");
  add_target(*verb, options.target);
  verb->add_option("--kind", options.kind, "idle, stall or drip")
      ->transform(CLI::CheckedTransformer(kinds));
  verb->add_option("--seconds", options.seconds, "At most, once all are open");
  verb->callback([&options] { hold(options); });
}

void add_ask(CLI::App& app, AskOptions& options) {
  CLI::App* verb = app.add_subcommand("ask", "Ask for something again and again");
  add_target(*verb, options.target);
  verb->add_option("--range", options.range, "A-B, bytes");
  verb->add_option("--rate", options.rate, "Requests a second in all; 0: as fast as it goes");
  verb->add_option("--read-rate", options.read_rate, "Bytes a second that each connection reads");
  verb->add_option("--times", options.times, "Requests of each connection; 0: any number");
  verb->add_option("--seconds", options.seconds)->capture_default_str();
  auto part = std::make_shared<std::tuple<std::string, std::uint64_t, std::uint64_t>>();
  verb->add_option("--file", *part, "FILE OFFSET LENGTH: the bytes of every body");
  verb->callback([&options, part] {
    const auto& [path, offset, length] = *part;
    if (!path.empty()) options.expected = read_part(path, offset, length);
    ask(options);
  });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The load of bench/serve that wrk cannot make"};
  app.require_subcommand(1);
  HoldOptions held;
  AskOptions asked;
  add_hold(app, held);
  add_ask(app, asked);
  CLI11_PARSE(app, argc, argv);
}
