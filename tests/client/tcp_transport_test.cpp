// The client against servers of the frame protocol on the loopback, good and bad.
#include <algorithm>

#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "tests/client/fetched.h"
#include "tests/client/loopback.h"
#include "tests/client/sample.h"
#include "tests/client/scripted_transport.h"

namespace pmesh {
namespace {

using test::Fetched;
using test::kImpatient;
using test::LoopbackServer;
using test::Peer;
using test::random_cuts;
using test::sample_file;
using test::sample_index;
using test::wish;

constexpr std::uint64_t kDataBytes = 500;

// What a frame server does wrong; by default nothing.
struct Behaviour {
  std::function<std::size_t()> cut_after{};  // if set: bytes of an answer until it is cut
  Bytes instead_of_opened{};
  Bytes instead_of_data{};
  Bytes before_data{};
  int stalls = 0;  // so many wants get no answer
};

Opened opened_sample() {
  const FileHeader& header = sample_index().header;
  return {header.content_hash,
          header.file_bytes,
          header.vertices,
          header.faces,
          header.base_vertices,
          header.base_faces,
          static_cast<std::uint32_t>(sample_index().chunks.size())};
}

// Serves the sample under any id.
class FrameServer {
 public:
  explicit FrameServer(Behaviour behaviour, Bytes file = sample_file())
      : file_(std::move(file)),
        behaviour_(std::move(behaviour)),
        server_([this](Peer& peer) { serve(peer); }) {}

  std::string url() const { return "tcp://127.0.0.1:" + std::to_string(server_.port()) + "/mesh"; }
  int connections() const { return server_.connections(); }
  const std::vector<Want>& wants() const { return wants_; }

 private:
  void serve(Peer& peer) {
    FrameParser parser;
    for (Bytes bytes = peer.receive(); !bytes.empty(); bytes = peer.receive()) {
      ByteView unread = bytes;
      while (parser.feed(unread) == FrameStep::done) {
        if (!answer(peer, parser.frame())) return;
      }
    }
  }

  bool answer(Peer& peer, const Frame& frame) {
    switch (frame.type) {
      case FrameType::hello:
        return peer.send(encode_hello({}));
      case FrameType::open:
        return peer.send(behaviour_.instead_of_opened.empty()
                             ? encode_opened(frame.stream, opened_sample())
                             : behaviour_.instead_of_opened);
      case FrameType::want:
        return answer_want(peer, frame);
      default:
        return true;
    }
  }

  bool answer_want(Peer& peer, const Frame& frame) {
    wants_.push_back(*parse_want(frame.payload));
    if (behaviour_.stalls > 0) {
      --behaviour_.stalls;
      return true;
    }
    const Resolution lod = *resolve(wants_.back().wish, sample_index());
    Bytes answer = behaviour_.before_data;
    const auto append = [&](const Bytes& bytes) {
      answer.insert(answer.end(), bytes.begin(), bytes.end());
    };
    for (std::uint64_t at = wants_.back().from_offset; at < lod.end; at += kDataBytes) {
      const std::uint64_t count = std::min(kDataBytes, lod.end - at);
      append(encode_data(frame.stream, {at, ByteView(file_).subspan(at, count)}));
    }
    append(encode_done(frame.stream, {lod.end, lod.faces, lod.vertices, lod.reached}));
    if (!behaviour_.instead_of_data.empty()) answer = behaviour_.instead_of_data;
    const std::size_t allowed = behaviour_.cut_after ? behaviour_.cut_after() : answer.size();
    peer.send(ByteView(answer).first(std::min(allowed, answer.size())));
    return allowed >= answer.size();
  }

  Bytes file_;
  Behaviour behaviour_;
  std::vector<Want> wants_;
  LoopbackServer server_;
};

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

TEST(TcpTransport, AnswersPingsBetweenTheData) {
  FrameServer server({.before_data = encode_empty(FrameType::ping, kConnectionStream)});
  const Fetched fetched(server.url());
  EXPECT_EQ(fetched.error(), "");
  EXPECT_TRUE(fetched.is_sample());
}

TEST(TcpTransport, LeavesAServerThatStallsAndAsksAgain) {
  FrameServer server({.stalls = 2});
  const Fetched fetched(server.url(), "", kImpatient);
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
  for (Behaviour behaviour :
       {Behaviour{.instead_of_opened = noise},
        Behaviour{.instead_of_opened = encode_data(1, {0, noise})},
        Behaviour{.instead_of_opened = encode_frame(FrameType::opened, 1, noise)},
        Behaviour{.instead_of_data = noise}, Behaviour{.instead_of_data = encode_hello({})},
        Behaviour{.instead_of_data = encode_data(2, {0, noise})},
        Behaviour{.instead_of_data = encode_data(1, {5, noise})},
        Behaviour{.instead_of_data = encode_frame(FrameType::data, 1, as_bytes("abc"))},
        Behaviour{.instead_of_data = encode_frame(FrameType{99}, 1, {})},
        Behaviour{.instead_of_data = encode_done(1, {0, 0, 0, true})}}) {
    FrameServer server(behaviour);
    const Fetched fetched(server.url(), "", kImpatient);  // after a gap no frame follows
    EXPECT_FALSE(fetched.status.ok());
    EXPECT_EQ(server.connections(), 1) << fetched.error();
  }
}

}  // namespace
}  // namespace pmesh
