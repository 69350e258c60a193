// What keeps a server in hand: places for addresses, trusted proxies, metrics, reloads, access.
#include <filesystem>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "tests/server/opened_mesh.h"
#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

using namespace std::chrono_literals;
using testing::fetch;
using testing::get_request;
using testing::HttpResponse;
using testing::make_sample;
using testing::read_response;
using testing::RunningServer;
using testing::SampleFile;
using testing::TestClient;

class OperationTest : public ::testing::Test {
 protected:
  void serve(const std::function<void(ServerOptions&)>& adjust = {}) {
    running_ = std::make_unique<RunningServer>([&](ServerOptions& options) {
      options.metrics = "127.0.0.1:0";
      if (adjust) adjust(options);
      options_ = options;
    });
    running_->directory().write("bunny.pmesh", bunny_.bytes);
  }
  std::string address() { return running_->server().http_address(); }
  std::string file() const { return "/bunny/" + bunny_.hash() + ".pmesh"; }

  /// The value of a line of /metrics; nothing if there is none.
  std::string metric(const std::string& name) {
    const std::string text = "\n" + fetch(running_->server().metrics_address(), "/metrics").body;
    const std::size_t begin = text.find("\n" + name + " ");
    if (begin == std::string::npos) return "";
    const std::size_t value = begin + name.size() + 2;
    return text.substr(value, text.find('\n', value) - value);
  }
  /// Waits until the metric has this value: what a connection counts at its end comes late.
  bool becomes(const std::string& name, const std::string& value) {
    for (int i = 0; i < 200; ++i) {
      if (metric(name) == value) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  const SampleFile bunny_ = make_sample();
  ServerOptions options_;
  std::unique_ptr<RunningServer> running_;
};

TEST_F(OperationTest, ThereAreSoManyConnectionsInAllAndPerAddress) {
  serve([](ServerOptions& options) { options.max_connections_per_address = 2; });
  {
    TestClient first(address());
    first.send(get_request("/health"));
    EXPECT_EQ(read_response(first).status, 200);
    TestClient frames(running_->server().tcp_address());
    EXPECT_NE(frames.receive(1), "");
    TestClient second(address());
    EXPECT_EQ(read_response(second).status, 503);
    EXPECT_EQ(second.receive_all(), "");
  }
  running_ = nullptr;
  serve([](ServerOptions& options) { options.max_connections = 1; });
  TestClient first(address());
  first.send(get_request("/health"));
  EXPECT_EQ(read_response(first).status, 200);
  EXPECT_EQ(fetch(address(), "/health").status, 503);
  EXPECT_EQ(metric(R"(pmesh_limits_total{limit="connections"})"), "1");
}

TEST_F(OperationTest, ConnectionsOfAProxyCountForItsClients) {
  serve([](ServerOptions& options) {
    options.max_connections_per_address = 1;
    options.trusted_proxies = {"127.0.0.0/8"};
  });
  TestClient first(address()), same(address()), other(address()), own(address());
  first.send("PROXY TCP4 203.0.113.9 127.0.0.1 1 2\r\n" + get_request("/health"));
  EXPECT_EQ(read_response(first).status, 200);
  same.send("PROXY TCP4 203.0.113.9 127.0.0.1 1 2\r\n" + get_request("/health"));
  EXPECT_EQ(read_response(same).status, 503);
  other.send("PROXY TCP4 203.0.113.10 127.0.0.1 1 2\r\n" + get_request("/health"));
  EXPECT_EQ(read_response(other).status, 200);
  own.send(get_request("/health"));
  EXPECT_EQ(read_response(own).status, 200);
}

TEST_F(OperationTest, AProxyHeaderMayComeInPieces) {
  serve([](ServerOptions& options) { options.trusted_proxies = {"127.0.0.1"}; });
  TestClient client(address());
  client.send("PROXY TCP4 203.0.");
  std::this_thread::sleep_for(20ms);
  client.send("113.9 127.0.0.1 1 2\r\n" + get_request(file()));
  EXPECT_EQ(read_response(client).body, bunny_.text());
}

TEST_F(OperationTest, ABadProxyHeaderEndsTheConnection) {
  serve([](ServerOptions& options) { options.trusted_proxies = {"127.0.0.1"}; });
  TestClient client(address());
  client.send("PROXY TCP4 nonsense\r\n" + get_request("/health"));
  EXPECT_EQ(client.receive_all(), "");
}

TEST_F(OperationTest, OthersAreNotBelievedForWhomTheySpeak) {
  serve();
  TestClient client(address());
  client.send("PROXY TCP4 203.0.113.9 127.0.0.1 1 2\r\n" + get_request("/health"));
  EXPECT_EQ(read_response(client).status, 400);
}

TEST_F(OperationTest, RequestsOfAProxyCountForItsClients) {
  const SampleFile large = make_sample({8'000'000, 8'000'000});
  serve([](ServerOptions& options) {
    options.max_connections_per_address = 1;
    options.trusted_proxies = {"127.0.0.1"};
  });
  running_->directory().write("large.pmesh", large.bytes);
  TestClient slow(address(), 4096), same(address()), other(address());
  slow.send(get_request("/large/" + large.hash() + ".pmesh", "X-Forwarded-For: 203.0.113.9\r\n"));
  EXPECT_NE(slow.receive(1), "");
  const auto ask = [](TestClient& client, const std::string& forwarded_for) {
    client.send(get_request("/health", "X-Forwarded-For: " + forwarded_for + "\r\n"));
    return read_response(client).status;
  };
  EXPECT_EQ(ask(same, "203.0.113.9"), 429);
  EXPECT_EQ(ask(same, "1.2.3.4, 203.0.113.9"), 429);
  EXPECT_EQ(ask(other, "203.0.113.10"), 200);
  EXPECT_EQ(ask(same, "203.0.113.11"), 200);  // refused requests do not end the proxy's connection
}

TEST_F(OperationTest, EachClientHasItsPartOfTheQueueOfLevels) {
  const EncodedShape shape = testing::closed_shape();
  const auto statuses = [&](const std::function<std::string(int)>& fields) {
    serve([](ServerOptions& options) {
      options.lod.per_address = 1;
      options.trusted_proxies = {"127.0.0.1"};
    });
    running_->directory().write("mesh.pmesh", shape.file);
    std::vector<std::unique_ptr<TestClient>> clients;
    for (int i = 0; i < 20; ++i) clients.push_back(std::make_unique<TestClient>(address()));
    for (int i = 0; i < 20; ++i) {
      const std::string target = "/mesh/lod.ply?faces=" + std::to_string(500 + 100 * i);
      clients[static_cast<std::size_t>(i)]->send(get_request(target, fields(i)));
    }
    std::map<int, int> counts;
    for (const auto& client : clients) {
      const HttpResponse response = read_response(*client);
      ++counts[response.status];
      EXPECT_EQ(response.field("Retry-After"), response.status == 503 ? "1" : "");
    }
    return counts;
  };
  const auto one_client = [](int) { return std::string("X-Forwarded-For: 203.0.113.9\r\n"); };
  const auto many_clients = [](int i) {
    return "X-Forwarded-For: 203.0.113." + std::to_string(i) + "\r\n";
  };
  std::map<int, int> counts = statuses(one_client);
  EXPECT_GT(counts[200], 0);
  EXPECT_GT(counts[503], 0);
  EXPECT_EQ(counts[200] + counts[503], 20);
  EXPECT_EQ(metric(R"(pmesh_limits_total{limit="lod_per_address"})"), std::to_string(counts[503]));
  EXPECT_EQ(statuses(many_clients)[200], 20);
  EXPECT_EQ(statuses([](int) { return std::string(); })[200], 20);  // the proxy's own
}

TEST_F(OperationTest, MetricsTellWhatHappened) {
  serve([](ServerOptions& options) { options.limits.idle_timeout = 50ms; });
  EXPECT_EQ(fetch(address(), file()).status, 200);
  EXPECT_EQ(fetch(address(), file(), "Range: bytes=0-1\r\n").status, 206);
  EXPECT_EQ(fetch(address(), "/nobody").status, 404);
  EXPECT_EQ(metric(R"(pmesh_requests_total{route="file",status="200"})"), "1");
  EXPECT_EQ(metric(R"(pmesh_requests_total{route="file",status="206"})"), "1");
  EXPECT_EQ(metric(R"(pmesh_requests_total{route="info",status="404"})"), "1");
  EXPECT_EQ(metric("pmesh_meshes"), "1");
  TestClient idle(address());
  idle.send(get_request("/health"));
  read_response(idle);
  EXPECT_EQ(idle.receive_all(), "");
  EXPECT_EQ(metric(R"(pmesh_limits_total{limit="idle_timeout"})"), "1");
  EXPECT_TRUE(becomes(R"(pmesh_connections{protocol="http"})", "1"));  // this one
}

TEST_F(OperationTest, LimitsAreCounted) {
  serve([](ServerOptions& options) { options.limits.header_timeout = 100ms; });
  const auto count = [&](const std::string& limit) {
    return metric("pmesh_limits_total{limit=\"" + limit + "\"}");
  };
  EXPECT_EQ(fetch(address(), "/" + std::string(9000, 'x')).status, 414);
  EXPECT_EQ(fetch(address(), "/health", "X: " + std::string(20000, 'x') + "\r\n").status, 431);
  std::string many;
  for (int i = 0; i < 101; ++i) many += "X: y\r\n";
  EXPECT_EQ(fetch(address(), "/health", many).status, 431);
  EXPECT_EQ(fetch(address(), file(), "Range: bytes=0-0,1-1,2-2,3-3,4-4,5-5,6-6,7-7,8-8\r\n").status,
            416);
  TestClient slow(address());
  slow.send("GET /");
  EXPECT_EQ(read_response(slow).status, 408);
  EXPECT_EQ(count("target_bytes"), "1");
  EXPECT_EQ(count("header_bytes"), "1");
  EXPECT_EQ(count("header_fields"), "1");
  EXPECT_EQ(count("ranges"), "1");
  EXPECT_EQ(count("header_timeout"), "1");
}

TEST_F(OperationTest, MetricsOnTheirOwnPortAreNotWithTheMeshes) {
  serve();
  EXPECT_EQ(fetch(address(), "/metrics").status, 404);
  EXPECT_EQ(fetch(running_->server().metrics_address(), "/catalog").status, 404);
  EXPECT_EQ(fetch(running_->server().metrics_address(), "/health").status, 200);
  running_ = nullptr;
  serve([](ServerOptions& options) { options.metrics.clear(); });
  EXPECT_EQ(fetch(address(), "/metrics").status, 200);
}

TEST_F(OperationTest, AReloadChangesLimitsAndAccessOfWhatIsOpen) {
  serve();
  TestClient client(address());
  client.send(get_request("/catalog"));
  EXPECT_EQ(read_response(client).status, 200);

  options_.access.tokens = {"0123456789abcdef"};
  options_.limits.ranges = 1;
  EXPECT_TRUE(running_->server().reload(options_).ok());
  client.send(get_request("/catalog"));
  EXPECT_EQ(read_response(client).status, 401);
  client.send(get_request(file(),
                          "Authorization: Bearer 0123456789abcdef\r\n"
                          "Range: bytes=0-1,4-5\r\n"));
  EXPECT_EQ(read_response(client).status, 416);
  EXPECT_EQ(metric(R"(pmesh_reloads_total{result="done"})"), "1");
}

TEST_F(OperationTest, AReloadLeavesOpenConnectionsAlone) {
  serve();
  TestClient client(address());
  for (int i = 0; i < 20; ++i) {
    client.send(get_request(file()));
    EXPECT_EQ(read_response(client).body, bunny_.text()) << i;
    EXPECT_TRUE(running_->server().reload(options_).ok());
  }
}

TEST_F(OperationTest, AFailedReloadChangesNothing) {
  serve();
  options_.access.tokens = {"0123456789abcdef"};
  options_.tls.certificate = "/nonexistent";
  EXPECT_EQ(running_->server().reload(options_).error().code, ErrorCode::usage);
  EXPECT_EQ(fetch(address(), "/catalog").status, 200);
  EXPECT_EQ(metric(R"(pmesh_reloads_total{result="failed"})"), "1");
}

TEST_F(OperationTest, SilentConnectionsEndEarly) {
  serve([](ServerOptions& options) { options.limits.header_timeout = 50ms; });
  EXPECT_EQ(TestClient(address()).receive_all(), "");
  const std::string greeting = TestClient(running_->server().tcp_address()).receive_all();
  EXPECT_FALSE(greeting.empty());
}

}  // namespace
}  // namespace pmesh
