// The client against WebSocket servers on the loopback, good and bad, and against hosts without.
#include <gtest/gtest.h>

#include "tests/client/fetched.h"
#include "tests/client/frame_host.h"
#include "tests/client/loopback.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"

namespace pmesh {
namespace {

using test::Fetched;
using test::FrameBehaviour;
using test::HttpHost;
using test::kImpatient;
using test::LoopbackServer;
using test::Peer;
using test::random_cuts;
using test::sample_file;
using test::sample_index;
using test::WebSocketServer;
using test::wish;

TEST(WebSocket, FetchesEverythingByFramesThatAreMessages) {
  WebSocketServer server({});
  const Fetched fetched(server.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_TRUE(server.was_one_frame_a_message());
  EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size());
}

TEST(WebSocket, AsksForTheStreamBelowTheMeshAndShowsWhoItIs) {
  WebSocketServer server({});
  std::string url = server.url();
  url.replace(url.rfind("/mesh"), 5, "/scans/mesh?expires=9&signature=ab");
  const Fetched fetched(url, "", {.token = "t"});
  EXPECT_EQ(fetched.error(), "");
  const std::string& request = server.requests().at(0);
  EXPECT_TRUE(request.starts_with("GET /scans/mesh/stream?expires=9&signature=ab HTTP/1.1\r\n"));
  EXPECT_NE(request.find("Authorization: Bearer t\r\n"), std::string::npos);
  EXPECT_EQ(request.find("Sec-WebSocket-Extensions"), std::string::npos);
}

TEST(WebSocket, RefinesOnTheSameConnection) {
  WebSocketServer server({});
  Fetched fetched(server.url(), "faces=1000");
  EXPECT_EQ(fetched.client.bytes_fetched(), resolve(wish("faces=1000"), sample_index())->end);
  ASSERT_TRUE(fetched.client.fetch(wish("")).ok());
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(server.connections(), 1);
}

TEST(WebSocket, SurvivesCutsInsideMessagesWithoutReadingTwice) {
  for (const std::size_t data_bytes : {500u, 100'000u}) {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      WebSocketServer server({.cut_after = random_cuts(seed, 9000), .data_bytes = data_bytes});
      const Fetched fetched(server.url());
      EXPECT_EQ(fetched.error(), "") << seed;
      EXPECT_TRUE(fetched.is_sample()) << seed;
      EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size()) << seed;
    }
  }
}

TEST(WebSocket, LeavesAServerThatStallsAndAsksAgain) {
  WebSocketServer server({.stalls = 1});
  const Fetched fetched(server.url(), "", {.idle_timeout = kImpatient});
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST(WebSocket, SaysThatAMeshIsNotFoundAtOnce) {
  WebSocketServer server(
      {.instead_of_opened = encode_failure(1, {FailureCode::not_found, "no such mesh"})});
  const Fetched fetched(server.url());
  EXPECT_NE(fetched.error().find("no such mesh"), std::string::npos);
  EXPECT_EQ(server.connections(), 1);
}

TEST(WebSocket, RefusesAServerThatBreaksTheFrameProtocol) {
  WebSocketServer server({.instead_of_data = Bytes(100, 0xFF)});
  const Fetched fetched(server.url());
  EXPECT_NE(fetched.error().find("broken protocol"), std::string::npos);
  EXPECT_EQ(server.connections(), 1);
}

// What a fetch from an HTTP host by its WebSocket URL comes to.
struct FellBack : Fetched {
  explicit FellBack(const HttpHost& host)
      : Fetched("ws" + host.url("/mesh").substr(4), "", {.idle_timeout = kImpatient}) {}
};

TEST(WebSocket, GoesOnOverHttpWhereTheUpgradeIsRefused) {
  for (const int status : {200, 302, 400, 404, 426, 500, 502, 503}) {
    HttpHost host(sample_file(), {.upgrade_status = status});
    const FellBack fetched(host);
    EXPECT_EQ(fetched.error(), "") << status;
    EXPECT_TRUE(fetched.is_sample()) << status;
    ASSERT_EQ(fetched.retries.size(), 1u) << status;
    EXPECT_NE(fetched.retries[0].find("going on over plain HTTP"), std::string::npos);
    EXPECT_NE(fetched.retries[0].find(std::to_string(status)), std::string::npos);
  }
}

TEST(WebSocket, DoesNotGoOnWhereItIsNotLetIn) {
  for (const int status : {401, 403}) {
    HttpHost host(sample_file(), {.upgrade_status = status});
    const FellBack fetched(host);
    EXPECT_NE(fetched.error().find("token"), std::string::npos) << fetched.error();
    EXPECT_EQ(host.targets(), std::vector<std::string>{"/mesh/stream"});
  }
}

TEST(WebSocket, GoesOnOverHttpAfterTwoFailuresWithoutAByte) {
  HttpHost host(sample_file(), {.upgrade_status = 0});
  const FellBack fetched(host);
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(fetched.retries.size(), 2u);
}

// A host whose first connection leads to a WebSocket server, and the others to a plain HTTP host.
class HalfHost {
 public:
  explicit HalfHost(FrameBehaviour behaviour, std::string raw = "")
      : web_socket_(std::move(behaviour), std::move(raw)) {}
  std::string url() const { return "ws://127.0.0.1:" + std::to_string(front_.port()) + "/mesh"; }

 private:
  WebSocketServer web_socket_;
  HttpHost host_{sample_file(), {}};
  LoopbackServer front_{[this](Peer& client) {
    test::pass(client, front_.connections() == 1 ? web_socket_.port() : host_.port());
  }};
};

TEST(WebSocket, KeepsWhatHasComeWhenItGoesOnOverHttp) {
  HalfHost host({.cut_after = [] { return std::size_t(30'000); }});
  const Fetched fetched(host.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size());
}

TEST(WebSocket, GoesOnOverHttpWhereTheMessagesAreNone) {
  const std::string text("\x81\x05hello", 7);
  const std::string too_large("\x82\x7F\x00\x00\x00\x00\x00\x20\x00\x00", 10);
  const std::string masked("\x82\x85\x01\x02\x03\x04hello", 11);
  const std::string no_opcode("\x87\x05hello", 7);
  for (const std::string& raw : {text, too_large, masked, no_opcode}) {
    HalfHost host({}, raw);
    const Fetched fetched(host.url());
    EXPECT_EQ(fetched.error(), "");
    EXPECT_TRUE(fetched.is_sample());
    ASSERT_EQ(fetched.retries.size(), 1u) << testing::PrintToString(fetched.retries);
    EXPECT_NE(fetched.retries[0].find("not a valid WebSocket"), std::string::npos);
  }
}

}  // namespace
}  // namespace pmesh
