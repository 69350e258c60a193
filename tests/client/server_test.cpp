// The client against the real server, over HTTP and TCP, with and without cuts on the way.
#include "server/server.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include "client/fetch_to_file.h"
#include "core/files/atomic_file.h"
#include "core/files/read_file.h"
#include "tests/client/fetched.h"
#include "tests/client/loopback.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using test::CuttingProxy;
using test::extracted;
using test::Fetched;
using test::random_cuts;
using test::wish;

constexpr const char* kWishes[] = {"",           "ratio=0.5",    "ratio=0.05", "faces=1000",
                                   "faces=1001", "vertices=501", "bytes=9000", "faces=3",
                                   "error=3",    "error=200%",   "error=0"};

void write(const std::string& path, ByteView bytes) {
  Result<AtomicFile> file = AtomicFile::create(path, Overwrite::yes);
  ASSERT_TRUE(file.ok() && file->write(bytes).ok() && file->commit().ok());
}

// Large enough for frames and chunks to be cut in the middle; closed, unlike the sample.
const Bytes& large_file() {
  static const Bytes file = test::make_pm_file(shapes::bumped(shapes::icosphere(6), 0.05));
  return file;
}

std::uint16_t port_of(const std::string& address) {
  return static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
}

class RealServer : public testing::Test {
 protected:
  RealServer() : folder_(testing::TempDir() + "pmesh_server_" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path("served"));
    write(path("served/sample.pmesh"), test::sample_file());
    write(path("served/large.pmesh"), large_file());
    write(path("served/unmeasured.pmesh"), test::other_file());
    ServerOptions options;
    options.directory = path("served");
    options.http = "127.0.0.1:0";
    options.tcp = "127.0.0.1:0";
    options.threads = 1;
    server_ = Server::open(options).value();
    thread_ = std::thread([this] { server_->run(); });
  }
  ~RealServer() override {
    server_->stop();
    thread_.join();
    std::filesystem::remove_all(folder_);
  }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::uint16_t http_port() const { return port_of(server_->http_address()); }
  std::uint16_t tcp_port() const { return port_of(server_->tcp_address()); }
  static std::string url(const char* scheme, std::uint16_t port, const std::string& id) {
    return std::string(scheme) + "://127.0.0.1:" + std::to_string(port) + "/" + id;
  }
  std::vector<std::string> urls(const std::string& id) const {
    return {url("http", http_port(), id), url("tcp", tcp_port(), id)};
  }

  static Result<FetchReport> fetch(const std::string& url, const char* query,
                                   const std::string& output) {
    const auto transport = make_transport(*parse_mesh_url(url), {});
    return fetch_to_file(*transport, {wish(query), output, false}, Fetched::stream_options());
  }

  std::string folder_;
  std::unique_ptr<Server> server_;
  std::thread thread_;
};

TEST_F(RealServer, GivesTheBytesOfAnExtractForEveryWish) {
  for (const std::string& url : urls("sample")) {
    for (const char* query : kWishes) {
      const Result<FetchReport> report = fetch(url, query, path("out.ply"));
      ASSERT_TRUE(report.ok()) << url << " " << query << ": " << report.error().message;
      EXPECT_EQ(*read_file(path("out.ply")), extracted(test::sample_file(), wish(query)))
          << url << " " << query;
      EXPECT_EQ(report->bytes_fetched, resolve(wish(query), test::sample_index())->end)
          << url << " " << query;
    }
  }
}

TEST_F(RealServer, RefusesAnErrorOfAMeshWithoutMeasuredErrors) {
  for (const std::string& url : urls("unmeasured")) {
    const Result<FetchReport> report = fetch(url, "error=1%", path("out.pmesh"));
    ASSERT_FALSE(report.ok()) << url;
    EXPECT_EQ(report.error().code, ErrorCode::usage) << url;
    EXPECT_NE(report.error().message.find("without measured errors"), std::string::npos) << url;
    EXPECT_FALSE(std::filesystem::exists(path("out.pmesh"))) << url;
  }
}

TEST_F(RealServer, SurvivesCutsAtRandomPlaces) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    CuttingProxy http(http_port(), random_cuts(seed, 200'000));
    CuttingProxy tcp(tcp_port(), random_cuts(seed, 500'000));
    for (const std::string& url :
         {url("http", http.port(), "large"), url("tcp", tcp.port(), "large")}) {
      const Fetched fetched(url);
      EXPECT_EQ(fetched.error(), "") << url << " seed " << seed;
      EXPECT_TRUE(std::ranges::equal(fetched.client.prefix().verified(), large_file()));
      EXPECT_EQ(fetched.client.bytes_fetched(), large_file().size()) << url << " seed " << seed;
    }
  }
}

TEST_F(RealServer, ContinuesAPartialFileOverAnyWire) {
  for (const std::string& url : urls("sample")) {
    std::uint64_t fetched = 0;
    for (const char* query : {"faces=500", "faces=8000", ""}) {
      const Result<FetchReport> continued = fetch(url, query, path("continued.pmesh"));
      ASSERT_TRUE(continued.ok()) << continued.error().message;
      fetched += continued->bytes_fetched;
    }
    EXPECT_EQ(fetched, test::sample_file().size()) << url;
    EXPECT_EQ(*read_file(path("continued.pmesh")), test::sample_file());
    std::filesystem::remove(path("continued.pmesh"));
  }
}

TEST_F(RealServer, ServesTheHashedFileAsAPlainHostToo) {
  const std::string hash = to_hex(test::sample_index().header.content_hash);
  const Fetched fetched(url("http", http_port(), "sample/" + hash + ".pmesh"));
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST_F(RealServer, SaysThatAMeshIsNotThere) {
  for (const std::string& url : urls("nothing")) {
    const Fetched fetched(url);
    ASSERT_FALSE(fetched.status.ok());
    EXPECT_EQ(fetched.status.error().code, ErrorCode::runtime) << fetched.error();
  }
}

TEST_F(RealServer, RefusesToContinueAFileThatWasReplaced) {
  for (const std::string& url : urls("sample")) {
    write(path("served/sample.pmesh"), test::sample_file());
    ASSERT_TRUE(fetch(url, "faces=500", path("old.pmesh")).ok());
    write(path("served/sample.pmesh"), test::other_file());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // names are looked at now and then
    const Result<FetchReport> report = fetch(url, "", path("old.pmesh"));
    ASSERT_FALSE(report.ok()) << url;
    EXPECT_NE(report.error().message.find("another"), std::string::npos) << report.error().message;
    std::filesystem::remove(path("old.pmesh"));
  }
}

}  // namespace
}  // namespace pmesh
