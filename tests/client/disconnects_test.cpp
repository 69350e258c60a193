// A thousand disconnects: the client fetches a mesh from the real server, again and again, through
// a proxy that breaks its connections. The mesh must come out right every time, and hardly a byte
// may be fetched twice.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "client/streaming_client.h"
#include "core/files/atomic_file.h"
#include "server/server.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"
#include "tests/fixtures/mesh_digest.h"
#include "tests/fixtures/shapes.h"
#include "tests/proxy/proxy.h"

namespace pmesh {
namespace {

using std::chrono::milliseconds;
using test::ProxyCounts;
using test::ProxyOptions;
using test::SeededProxy;

// Of each way to fetch; and a connection breaks within so many bytes.
#ifdef __SANITIZE_THREAD__
constexpr int kSphereLevel = 5;
constexpr std::uint64_t kDisconnects = 20;
constexpr std::uint64_t kBreakBytes = 32 * 1024;
#else
constexpr int kSphereLevel = 7;  // 327,680 faces
constexpr std::uint64_t kDisconnects = 250;
constexpr std::uint64_t kBreakBytes = 160 * 1024;
#endif

const Bytes& large_file() {
  static const Bytes file =
      test::make_pm_file(shapes::bumped(shapes::icosphere(kSphereLevel), 0.05));
  return file;
}

std::uint32_t digest_of(StreamingClient& client) { return digest(client.mesh().snapshot()); }

std::uint32_t expected_digest() {
  static const std::uint32_t value = [] {
    test::ScriptedTransport whole(large_file());
    StreamingClient client(whole, {});
    return client.fetch({}).ok() ? digest_of(client) : 0;
  }();
  return value;
}

std::uint16_t port_of(const std::string& address) {
  return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
}

// What a network may do to a mesh on its way; what is for HTTP alone has no effect on TCP.
ProxyOptions hostile(std::uint16_t upstream_port, bool is_http) {
  ProxyOptions options;
  options.upstream_port = upstream_port;
  options.seed = 20250101;
  options.link.bits_per_second_down = 2'000'000'000;
  options.link.delay = std::chrono::microseconds(200);
  options.link.stall_probability = 0.01;
  options.link.stall = milliseconds(3);
  options.reset_probability = 0.95;
  options.reset_bytes = kBreakBytes;
  options.is_http = is_http;
  options.short_body_probability = 0.2;
  options.short_bytes = kBreakBytes;
  options.drop_range_probability = 0.03;
  options.bad_gateway_probability = 0.03;
  return options;
}

// What came of one way to fetch. Fetched are the bytes of the file that the client took from its
// sockets, those included that it skipped or declined where a whole file came instead of a range.
struct Tally {
  std::uint64_t fetches = 0;
  std::uint64_t wanted = 0;  // bytes
  std::uint64_t fetched = 0;
};

class Disconnects : public testing::Test {
 protected:
  Disconnects() : folder_(testing::TempDir() + "pmesh_disconnects_" + std::to_string(::getpid())) {
    std::filesystem::create_directories(folder_);
    Result<AtomicFile> file = AtomicFile::create(folder_ + "/large.pmesh", Overwrite::yes);
    EXPECT_TRUE(file.ok() && file->write(large_file()).ok() && file->commit().ok());
    ServerOptions options;
    options.directory = folder_;
    options.http = "127.0.0.1:0";
    options.tcp = "127.0.0.1:0";
    options.threads = 1;
    server_ = Server::open(options).value();
    thread_ = std::thread([this] { server_->run(); });
  }
  ~Disconnects() override {
    server_->stop();
    thread_.join();
    std::filesystem::remove_all(folder_);
  }

  // Fetches the mesh by "SCHEME://proxy/PATH" until there have been enough disconnects.
  void fetch_through(const ProxyOptions& options, const std::string& scheme,
                     const std::string& path) {
    const SeededProxy proxy(options);
    const std::string url = scheme + "://127.0.0.1:" + std::to_string(proxy.port()) + "/" + path;
    Tally tally;
    while (proxy.counts().disconnects() < kDisconnects && !HasFailure()) fetch(url, tally);
    print(url, tally, proxy.counts());
    EXPECT_LE(tally.fetched - tally.wanted, tally.wanted / 20) << url;
  }

  static void fetch(const std::string& url, Tally& tally) {
    const std::unique_ptr<Transport> transport = make_transport(*parse_mesh_url(url), {});
    StreamOptions options;
    options.retry = {.max_failures = 30,
                     .first_delay = milliseconds(1),
                     .longest_delay = milliseconds(4),
                     .seed = static_cast<std::uint32_t>(tally.fetches)};
    StreamingClient client(*transport, options);
    const Status status = client.fetch({});
    ASSERT_TRUE(status.ok()) << url << ": " << status.error().message;
    ASSERT_TRUE(std::ranges::equal(client.prefix().verified(), large_file())) << url;
    ASSERT_EQ(digest_of(client), expected_digest()) << url;
    ++tally.fetches;
    tally.wanted += large_file().size();
    tally.fetched += client.bytes_fetched();
  }

  // Also what the proxy sent, which depends on timing: heads of answers and frames, the mesh's
  // JSON, and what of the whole files that the client declined was under way by then.
  static void print(const std::string& url, const Tally& tally, const ProxyCounts& counts) {
    std::printf(
        "%s: %llu fetches of %zu bytes, %.2f %% of them twice, %.2f %% more on the wire; %s\n",
        url.c_str(), static_cast<unsigned long long>(tally.fetches), large_file().size(),
        percent_more(tally.fetched, tally.wanted), percent_more(counts.bytes_down, tally.wanted),
        to_json(counts).c_str());
  }
  static double percent_more(std::uint64_t bytes, std::uint64_t wanted) {
    return 100 * (static_cast<double>(bytes) / static_cast<double>(wanted) - 1);
  }

  std::uint16_t http_port() const { return port_of(server_->http_address()); }
  std::uint16_t tcp_port() const { return port_of(server_->tcp_address()); }

  std::string folder_;
  std::unique_ptr<Server> server_;
  std::thread thread_;
};

TEST_F(Disconnects, OverHttp) { fetch_through(hostile(http_port(), true), "http", "large"); }

TEST_F(Disconnects, FromAPlainHost) {
  const FileIndex index = **parse_prologue(large_file());
  fetch_through(hostile(http_port(), true), "http",
                "large/" + to_hex(index.header.content_hash) + ".pmesh");
}

TEST_F(Disconnects, OverTcp) { fetch_through(hostile(tcp_port(), false), "tcp", "large"); }

TEST_F(Disconnects, OverWebSocket) { fetch_through(hostile(http_port(), true), "ws", "large"); }

}  // namespace
}  // namespace pmesh
