// soak PMESH DIR: starts `pmesh serve DIR` and visits it for a while with many clients, which ask
// for anything, by HTTP, TCP and WebSocket, and often leave early. Every byte is checked against
// the files. Once all are gone, the server must have as many descriptors, and as much memory, as
// after the warm-up.
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "tests/soak/server_process.h"
#include "tests/soak/visit.h"

namespace pmesh::soak {

namespace asio = boost::asio;
using Clock = std::chrono::steady_clock;
using std::chrono::seconds;

/// For the last visits: all that is on its way must be taken and looked at.
constexpr seconds kTimeToEnd{60};

asio::awaitable<Socket> connect(Visitor& visitor, std::uint16_t port) {
  const auto executor = co_await asio::this_coro::executor;
  const asio::ip::tcp::endpoint server(asio::ip::address_v4::loopback(), port);
  Socket socket(executor, asio::ip::tcp::v4());
  socket.bind({visitor.from, 0});
  co_await socket.async_connect(server, asio::use_awaitable);
  ++visitor.tally.connections;
  co_return socket;
}

void abort(Visitor& visitor, Socket& socket) {
  ++visitor.tally.aborts;
  if (once_in(visitor.random, 2)) socket.set_option(asio::socket_base::linger(true, 0));
  socket.close();
}

namespace {

struct Options {
  std::string program;
  std::string directory;
  int seconds = 60;
  int clients = 200;
  std::uint64_t seed = 1;
  std::int64_t most_growth = 1024 * 1024;  // of the private memory; negative: any
};

/// Visits until the time is up, each on its own connection.
asio::awaitable<void> live(Visitor& visitor, Clock::time_point until) {
  while (Clock::now() < until) {
    const std::uint64_t kind = below(visitor.random, 10);
    try {
      if (kind < 6) {
        co_await visit_http(visitor);
      } else if (kind < 8) {
        co_await visit_tcp(visitor);
      } else {
        co_await visit_web_socket(visitor);
      }
    } catch (const boost::system::system_error& error) {
      visitor.fault(std::string("a visit ended: ") + error.what());
    }
  }
}

class Soak {
 public:
  explicit Soak(const Options& options)
      : options_(options), meshes_(read_meshes(options.directory)) {
    for (int i = 0; i < options.clients; ++i) {
      const asio::ip::address_v4 from(0x7f000002 + static_cast<std::uint32_t>(i));
      visitors_.push_back({meshes_, http_port_, tcp_port_, from,
                           Random(options.seed + static_cast<std::uint64_t>(i)), tally_, levels_});
    }
  }

  /// True if all was well.
  bool run() {
    wait_until_served();
    const int warm_up = std::min(options_.seconds / 3, 60);
    visit(seconds(warm_up));
    const Usage before = settled();
    visit(seconds(options_.seconds - warm_up));
    const Usage after = settled();
    const int status = server_.finish();
    report(before, after, status);
    const std::int64_t growth = after.private_bytes - before.private_bytes;
    const bool is_flat = options_.most_growth < 0 || growth <= options_.most_growth;
    return tally_.faults.empty() && tally_.answers > 0 && is_flat &&
           after.descriptors == before.descriptors && status == 0;
  }

 private:
  void wait_until_served() {
    asio::io_context context;
    for (int i = 0; i < 200; ++i) {
      Socket socket(context);
      boost::system::error_code error;
      socket.connect({asio::ip::address_v4::loopback(), tcp_port_}, error);
      if (!error) return;
      asio::steady_timer(context, std::chrono::milliseconds(100)).wait();
    }
    tally_.faults.push_back("the server did not start");
  }

  void visit(Clock::duration time) {
    asio::io_context context(1);
    for (Visitor& visitor : visitors_) {
      asio::co_spawn(context, live(visitor, Clock::now() + time), asio::detached);
    }
    context.run_for(time + kTimeToEnd);
    if (!context.stopped()) tally_.faults.push_back("a visit did not come to its end");
  }

  /// Once the server has noticed that all are gone.
  Usage settled() const {
    asio::io_context context;
    asio::steady_timer(context, seconds(3)).wait();
    return server_.usage();
  }

  void report(const Usage& before, const Usage& after, int status) const {
    std::printf("%llu connections, %llu answers, %.1f GB, %llu left early, %llu levels refused\n",
                static_cast<unsigned long long>(tally_.connections),
                static_cast<unsigned long long>(tally_.answers), double(tally_.bytes) / 1e9,
                static_cast<unsigned long long>(tally_.aborts),
                static_cast<unsigned long long>(tally_.busy));
    std::printf("private memory %.2f MiB after the warm-up, %.2f MiB at the end\n",
                double(before.private_bytes) / (1 << 20), double(after.private_bytes) / (1 << 20));
    std::printf("%lld descriptors after the warm-up, %lld at the end; exit status %d\n",
                static_cast<long long>(before.descriptors),
                static_cast<long long>(after.descriptors), status);
    std::printf("%zu faults\n", tally_.faults.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(tally_.faults.size(), 20); ++i) {
      std::printf("  %s\n", tally_.faults[i].c_str());
    }
  }

  const Options& options_;
  const std::uint16_t http_port_ = free_port();
  const std::uint16_t tcp_port_ = free_port();
  // A cache of levels that is full early, so that memory can be flat.
  ServerProcess server_{{options_.program, "serve", options_.directory, "--http",
                         "127.0.0.1:" + std::to_string(http_port_), "--tcp",
                         "127.0.0.1:" + std::to_string(tcp_port_), "--lod-cache-bytes", "65536",
                         "--log-level", "warn"}};
  const std::vector<SoakMesh> meshes_;
  Tally tally_;
  std::map<std::string, std::string> levels_;
  std::vector<Visitor> visitors_;
};

}  // namespace
}  // namespace pmesh::soak

int main(int argc, char** argv) {
  CLI::App app{"Visits `pmesh serve` for a while and checks every byte"};
  pmesh::soak::Options options;
  app.add_option("PMESH", options.program)->required();
  app.add_option("DIR", options.directory, "PM files")->required();
  app.add_option("--seconds", options.seconds)->capture_default_str();
  app.add_option("--clients", options.clients)->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  app.add_option("--most-growth", options.most_growth,
                 "Of the server's private memory, in bytes; "
                 "negative: any")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return pmesh::soak::Soak(options).run() ? 0 : 1;
}
