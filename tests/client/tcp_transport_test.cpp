// The client against servers of the frame protocol on the loopback, good and bad.
#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "tests/client/fetched.h"
#include "tests/client/frame_host.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"

namespace pmesh {
namespace {

using test::Fetched;
using test::FrameBehaviour;
using test::FrameServer;
using test::kImpatient;
using test::random_cuts;
using test::sample_file;
using test::sample_index;
using test::wish;

TEST(TcpTransport, FetchesEverythingByOneWant) {
  FrameServer server({});
  const Fetched fetched(server.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(server.wants().size(), 1u);
}

TEST(TcpTransport, FetchesNoMoreThanTheWishNeeds) {
  FrameServer server({});
  const Fetched fetched(server.url(), "faces=1000");
  EXPECT_EQ(fetched.error(), "");
  EXPECT_EQ(fetched.client.bytes_fetched(), resolve(wish("faces=1000"), sample_index())->end);
}

TEST(TcpTransport, ShowsTheSignatureOfItsUrl) {
  FrameServer server({});
  EXPECT_EQ(Fetched(server.url() + "?expires=9&signature=ab").error(), "");
  EXPECT_EQ(server.opened(), std::vector<std::string>{"mesh?expires=9&signature=ab"});
}

TEST(TcpTransport, ShowsItsTokenFirst) {
  FrameServer server({});
  EXPECT_EQ(Fetched(server.url(), "", {.token = "secret"}).error(), "");
  EXPECT_EQ(server.opened(), (std::vector<std::string>{"token secret", "mesh"}));
}

TEST(TcpTransport, RefinesOnTheSameConnection) {
  FrameServer server({});
  Fetched fetched(server.url(), "faces=1000");
  ASSERT_TRUE(fetched.client.fetch(wish("")).ok());
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(server.connections(), 1);
  EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size());
}

TEST(TcpTransport, SurvivesCutsAtRandomPlacesWithoutReadingTwice) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    FrameServer server({.cut_after = random_cuts(seed, 9000)});
    const Fetched fetched(server.url());
    EXPECT_EQ(fetched.error(), "") << seed;
    EXPECT_TRUE(fetched.is_sample()) << seed;
    EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size()) << seed;
  }
}

TEST(TcpTransport, KeepsTheBytesOfAFrameThatWasCut) {
  FrameServer server({.cut_after = random_cuts(3, 9000), .data_bytes = 100'000});
  const Fetched fetched(server.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
  EXPECT_EQ(fetched.client.bytes_fetched(), sample_file().size());
}

TEST(TcpTransport, AnswersPingsBetweenTheData) {
  FrameServer server({.before_data = encode_empty(FrameType::ping, kConnectionStream)});
  const Fetched fetched(server.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST(TcpTransport, LeavesAServerThatStallsAndAsksAgain) {
  FrameServer server({.stalls = 2});
  const Fetched fetched(server.url(), "", {.idle_timeout = kImpatient});
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST(TcpTransport, SaysThatAMeshIsNotFoundAtOnce) {
  FrameServer server(
      {.instead_of_opened = encode_failure(1, {FailureCode::not_found, "no such mesh"})});
  const Fetched fetched(server.url());
  EXPECT_NE(fetched.error().find("no such mesh"), std::string::npos);
  EXPECT_EQ(server.connections(), 1);
}

TEST(TcpTransport, ComesAgainToABusyServer) {
  FrameServer server({.instead_of_opened = encode_failure(0, {FailureCode::busy, "busy"})});
  EXPECT_NE(Fetched(server.url()).error().find("gave up"), std::string::npos);
  EXPECT_EQ(server.connections(), 5);
}

TEST(TcpTransport, NoticesWrongBytes) {
  Bytes file = sample_file();
  file[sample_index().chunks[1].offset + 3] ^= 4;
  FrameServer server({}, file);
  const Fetched fetched(server.url());
  ASSERT_FALSE(fetched.status.ok());
  EXPECT_EQ(fetched.status.error().code, ErrorCode::verification);
}

TEST(TcpTransport, RefusesAServerThatBreaksTheProtocol) {
  const Bytes noise(100, 0xFF);
  for (FrameBehaviour behaviour :
       {FrameBehaviour{.instead_of_opened = noise},
        FrameBehaviour{.instead_of_opened = encode_data(1, {0, noise})},
        FrameBehaviour{.instead_of_opened = encode_frame(FrameType::opened, 1, noise)},
        FrameBehaviour{.instead_of_data = noise},
        FrameBehaviour{.instead_of_data = encode_hello({})},
        FrameBehaviour{.instead_of_data = encode_data(2, {0, noise})},
        FrameBehaviour{.instead_of_data = encode_data(1, {5, noise})},
        FrameBehaviour{.instead_of_data = encode_frame(FrameType::data, 1, as_bytes("abc"))},
        FrameBehaviour{.instead_of_data = encode_frame(FrameType{99}, 1, {})},
        FrameBehaviour{.instead_of_data = encode_done(1, {0, 0, 0, true})}}) {
    FrameServer server(behaviour);
    const Fetched fetched(server.url(), "",
                          {.idle_timeout = kImpatient});  // after a gap no frame follows
    EXPECT_FALSE(fetched.status.ok());
    EXPECT_EQ(server.connections(), 1) << fetched.error();
  }
}

}  // namespace
}  // namespace pmesh
