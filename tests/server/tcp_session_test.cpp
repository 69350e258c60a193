#include <filesystem>

#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "tests/server/descriptor_limit.h"
#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

using namespace std::chrono_literals;
using testing::make_sample;
using testing::RunningServer;
using testing::SampleFile;
using testing::TestClient;

std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// What came of one want: the data, put together, and the frame that answered it.
struct Delivery {
  std::uint64_t begin = 0;
  std::string bytes;
  Frame answer;

  Done done() const { return parse_done(answer.payload).value(); }
};

class TcpSessionTest : public ::testing::Test {
 protected:
  void serve(const std::function<void(ServerOptions&)>& adjust = {}) {
    running_ = std::make_unique<RunningServer>(adjust);
    running_->directory().write("bunny.pmesh", bunny_.bytes);
  }

  /// Connects and exchanges hellos.
  void connect(std::uint32_t max_frame = kMaxFramePayload, int receive_buffer_bytes = 0) {
    client_ = std::make_unique<TestClient>(running_->server().tcp_address(), receive_buffer_bytes);
    send(encode_hello({.max_frame = max_frame}));
    EXPECT_EQ(next().type, FrameType::hello);
  }

  void connect_and_open() {
    connect();
    send(encode_open(1, {.id = "bunny", .hash = {}}));
    EXPECT_EQ(next().type, FrameType::opened);
  }

  void send(const Bytes& frame) { client_->send(text(frame)); }

  void want(std::string_view query, std::uint64_t from = 0) {
    send(encode_want(1, {from, parse_wish(query).value()}));
  }

  /// The next frame; one of type 0 if the connection ended.
  Frame next() {
    const std::string header = client_->receive(kFrameHeaderBytes);
    if (header.size() < kFrameHeaderBytes) return {};
    ByteReader reader(as_bytes(header));
    const std::string payload = client_->receive(reader.get<std::uint32_t>());
    const std::string whole = header + payload;
    FrameParser parser;
    ByteView view = as_bytes(whole);
    EXPECT_EQ(parser.feed(view), FrameStep::done);
    return parser.frame();
  }

  Delivery delivery() {
    Delivery delivery;
    while (true) {
      delivery.answer = next();
      if (delivery.answer.type != FrameType::data) return delivery;
      const Data data = parse_data(delivery.answer.payload).value();
      if (delivery.bytes.empty()) delivery.begin = data.offset;
      EXPECT_EQ(data.offset, delivery.begin + delivery.bytes.size());
      delivery.bytes.append(data.bytes.begin(), data.bytes.end());
    }
  }

  void expect_failure(std::uint16_t stream, FailureCode code) {
    expect_failure(next(), stream, code);
  }
  void expect_failure(const Frame& frame, std::uint16_t stream, FailureCode code) {
    ASSERT_EQ(frame.type, FrameType::failure);
    EXPECT_EQ(frame.stream, stream);
    EXPECT_EQ(parse_failure(frame.payload).value().code, code);
  }
  /// A failure of the whole connection, and its end.
  void expect_end(FailureCode code) {
    expect_failure(kConnectionStream, code);
    EXPECT_EQ(client_->receive_all(), "");
  }
  void expect_alive() {
    send(encode_empty(FrameType::ping, kConnectionStream));
    EXPECT_EQ(next().type, FrameType::pong);
  }

  SampleFile bunny_ = make_sample();
  std::unique_ptr<RunningServer> running_;
  std::unique_ptr<TestClient> client_;
};

SampleFile large_sample() { return make_sample({8'000'000, 8'000'000}); }

TEST_F(TcpSessionTest, OpenedTellsTheCounts) {
  serve();
  connect();
  send(encode_open(7, {.id = "bunny", .hash = {}}));
  const Frame frame = next();
  const FileHeader& header = bunny_.index.header;
  EXPECT_EQ(frame.stream, 7);
  EXPECT_EQ(parse_opened(frame.payload).value(),
            (Opened{header.content_hash, header.file_bytes, header.vertices, header.faces,
                    header.base_vertices, header.base_faces, 3}));
}

TEST_F(TcpSessionTest, WantGivesTheWholeFile) {
  serve();
  connect_and_open();
  want("");
  const Delivery got = delivery();
  EXPECT_EQ(got.begin, 0u);
  EXPECT_EQ(got.bytes, bunny_.text());
  EXPECT_EQ(got.done(), (Done{bunny_.bytes.size(), 76, 40, true}));
}

TEST_F(TcpSessionTest, WantGivesTheBytesOfAWish) {
  serve();
  connect_and_open();
  want("faces=36");
  const std::uint64_t end = bunny_.index.chunks[0].end();
  const Delivery got = delivery();
  EXPECT_EQ(got.bytes, bunny_.text(0, end));
  EXPECT_EQ(got.done(), (Done{end, 36, 20, true}));
}

TEST_F(TcpSessionTest, WantGoesOnFromAnOffset) {
  serve();
  connect_and_open();
  const std::uint64_t from = bunny_.index.chunks[1].offset;
  want("", from);
  const Delivery got = delivery();
  EXPECT_EQ(got.begin, from);
  EXPECT_EQ(got.bytes, bunny_.text(from, bunny_.bytes.size()));
}

TEST_F(TcpSessionTest, WantOfWhatIsThereAlreadyIsDoneAtOnce) {
  serve();
  connect_and_open();
  want("faces=36", bunny_.bytes.size());
  const Delivery got = delivery();
  EXPECT_EQ(got.bytes, "");
  EXPECT_EQ(got.done().end, bunny_.index.chunks[0].end());
}

TEST_F(TcpSessionTest, WantBelowTheBaseIsNotReached) {
  serve();
  connect_and_open();
  want("faces=1");
  EXPECT_FALSE(delivery().done().reached);
}

TEST_F(TcpSessionTest, WantOfAnErrorGivesTheFirstChunkEndNearEnough) {
  bunny_ = testing::make_measured_sample();
  serve();
  connect_and_open();
  const std::uint64_t end = bunny_.index.chunks[1].end();
  for (const char* query : {"error=2", "error=0.03%"}) {
    want(query);
    const Delivery got = delivery();
    EXPECT_EQ(got.bytes, bunny_.text(0, end)) << query;
    EXPECT_EQ(got.done(), (Done{end, 56, 30, true})) << query;
  }
}

TEST_F(TcpSessionTest, WantOfAnErrorOutOfReachGivesTheWholeFile) {
  bunny_ = testing::make_measured_sample();
  serve();
  connect_and_open();
  want("error=0.9");
  const Delivery got = delivery();
  EXPECT_EQ(got.bytes, bunny_.text());
  EXPECT_FALSE(got.done().reached);
}

TEST_F(TcpSessionTest, SendsALargeFileInFramesOfTheAskedSize) {
  bunny_ = large_sample();
  serve();
  connect(4096);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  next();
  want("");
  EXPECT_LE(next().payload.size(), 4096u);
  EXPECT_TRUE(bunny_.text().ends_with(delivery().bytes));
}

TEST_F(TcpSessionTest, PauseStopsAndResumeGoesOn) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  send(encode_empty(FrameType::pause, 1));
  send(encode_empty(FrameType::ping, 0));
  Delivery first = delivery();  // up to the pong
  EXPECT_EQ(first.answer.type, FrameType::pong);
  EXPECT_LT(first.bytes.size(), bunny_.bytes.size());
  expect_alive();  // nothing comes between

  send(encode_empty(FrameType::resume, 1));
  const Delivery rest = delivery();
  EXPECT_EQ(rest.answer.type, FrameType::done);
  EXPECT_TRUE(first.bytes + rest.bytes == bunny_.text());
}

TEST_F(TcpSessionTest, CancelAnswersTheWant) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  send(encode_empty(FrameType::cancel, 1));
  expect_failure(delivery().answer, 1, FailureCode::cancelled);
  expect_alive();
}

TEST_F(TcpSessionTest, SecondWantReplacesTheFirst) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  want("bytes=0");
  expect_failure(delivery().answer, 1, FailureCode::cancelled);
  const Delivery second = delivery();
  EXPECT_EQ(second.bytes, bunny_.text(0, bunny_.index.base_end()));
  EXPECT_FALSE(second.done().reached);
}

TEST_F(TcpSessionTest, ControlOfNothingIsIgnored) {
  serve();
  connect_and_open();
  for (const FrameType type : {FrameType::pause, FrameType::resume, FrameType::cancel}) {
    send(encode_empty(type, 1));
    send(encode_empty(type, 9));
  }
  expect_alive();
}

TEST_F(TcpSessionTest, BadWishesFailOnTheirStream) {
  serve();
  connect_and_open();
  send(encode_frame(FrameType::want, 1, as_bytes(std::string(8, '\0') + "color=red")));
  expect_failure(1, FailureCode::bad_wish);
  want("chunks=0-99");
  expect_failure(1, FailureCode::bad_wish);
  want("error=1");  // of a mesh without measured errors
  expect_failure(1, FailureCode::bad_wish);
  want("", bunny_.bytes.size() + 1);
  expect_failure(1, FailureCode::bad_wish);
  expect_alive();
}

TEST_F(TcpSessionTest, OpenFailsOnItsStream) {
  serve();
  connect();
  for (const char* id : {"nobody", "", "..", "a/b", "health"}) {
    send(encode_open(1, {.id = id, .hash = {}}));
    expect_failure(1, FailureCode::not_found);
  }
  send(encode_open(1, {.id = "bunny", .hash = ContentHash{}}));
  expect_failure(1, FailureCode::hash_changed);
  send(encode_want(1, {}));
  expect_failure(1, FailureCode::not_open);
  expect_alive();
}

TEST_F(TcpSessionTest, OpenOfAMeshThatCannotBeOpenedNowMayBeTriedAgain) {
  if (!testing::DescriptorLimit::can_leave_none()) GTEST_SKIP() << "sanitizers need descriptors";
  serve();
  connect();
  running_->directory().write("late.pmesh", bunny_.bytes);
  {
    const testing::DescriptorLimit limit(testing::DescriptorLimit::none_left());
    send(encode_open(1, {.id = "late", .hash = {}}));
    expect_failure(1, FailureCode::busy);
  }
  send(encode_open(1, {.id = "late", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
}

TEST_F(TcpSessionTest, OneStreamCanBeOpen) {
  serve();
  connect_and_open();
  send(encode_open(2, {.id = "bunny", .hash = {}}));
  expect_failure(2, FailureCode::too_many_streams);
  send(encode_want(2, {}));
  expect_failure(2, FailureCode::not_open);
  send(encode_open(1, {.id = "bunny", .hash = bunny_.index.header.content_hash}));
  EXPECT_EQ(next().type, FrameType::opened);
}

TEST_F(TcpSessionTest, TakesFramesByteByByte) {
  serve();
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  std::string bytes = text(encode_hello({})) + text(encode_open(1, {.id = "bunny", .hash = {}}));
  bytes += text(encode_want(1, {}));
  for (const char byte : bytes) client_->send({&byte, 1});
  EXPECT_EQ(next().type, FrameType::hello);
  EXPECT_EQ(next().type, FrameType::opened);
  EXPECT_EQ(delivery().bytes, bunny_.text());
}

TEST_F(TcpSessionTest, HelloMustComeFirstAndOnce) {
  serve();
  connect();
  send(encode_hello({}));
  expect_end(FailureCode::protocol_error);
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  send(encode_empty(FrameType::ping, 0));
  EXPECT_EQ(next().type, FrameType::hello);
  expect_end(FailureCode::protocol_error);
}

TEST_F(TcpSessionTest, OtherVersionsAreNotSpoken) {
  serve();
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  send(encode_hello({.version = 77}));
  EXPECT_EQ(next().type, FrameType::hello);
  expect_end(FailureCode::unsupported_version);

  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  const std::string longer("PMTP\x01\0\0\0\x10\0 and more", 19);
  send(encode_frame(FrameType::hello, 0, as_bytes(longer)));
  EXPECT_EQ(next().type, FrameType::hello);
  expect_end(FailureCode::unsupported_version);
}

TEST_F(TcpSessionTest, WhatBreaksTheRulesEndsTheConnection) {
  serve();
  for (const Bytes& frame :
       {encode_empty(FrameType::opened, 1), encode_empty(static_cast<FrameType>(99), 1),
        encode_empty(FrameType::want, 1), encode_want(0, {}), encode_empty(FrameType::open, 1),
        encode_open(0, {.id = "bunny", .hash = {}}), Bytes{0, 0, 0, 0, 10, 1, 0, 0},
        Bytes{0xFF, 0xFF, 0xFF, 0xFF, 10, 0, 0, 0},
        encode_frame(FrameType::ping, 0, as_bytes("x"))}) {
    connect();
    send(frame);
    expect_end(FailureCode::protocol_error);
  }
}

TEST_F(TcpSessionTest, HttpOnTheWrongPortIsAnsweredAndClosed) {
  serve();
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  client_->send("GET / HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(next().type, FrameType::hello);
  expect_end(FailureCode::protocol_error);
}

TEST_F(TcpSessionTest, IdleConnectionsEnd) {
  serve([](ServerOptions& options) { options.limits.idle_timeout = 50ms; });
  connect_and_open();
  expect_end(FailureCode::idle_timeout);
}

TEST_F(TcpSessionTest, APausedTransferIsIdle) {
  bunny_ = large_sample();
  serve([](ServerOptions& options) { options.limits.idle_timeout = 50ms; });
  connect_and_open();
  want("");
  send(encode_empty(FrameType::pause, 1));
  expect_failure(delivery().answer, 0, FailureCode::idle_timeout);
}

TEST_F(TcpSessionTest, ResetsAPeerThatDoesNotRead) {
  bunny_ = large_sample();
  serve([](ServerOptions& options) { options.limits.send_timeout = 50ms; });
  connect(kMaxFramePayload, 4096);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  want("");
  client_->wait_for_end();
  EXPECT_LT(client_->receive_all().size(), bunny_.bytes.size());
  EXPECT_TRUE(client_->was_reset());
}

TEST_F(TcpSessionTest, AFloodOfPingsIsAnsweredPingByPing) {
  serve();
  connect();
  constexpr int kPings = 50'000;  // their answers exceed what may be queued
  std::thread flood([&] {
    for (int i = 0; i < kPings; ++i) send(encode_empty(FrameType::ping, 0));
  });
  for (int i = 0; i < kPings; ++i) ASSERT_EQ(next().type, FrameType::pong);
  flood.join();
  expect_alive();
}

TEST_F(TcpSessionTest, CutsATransferOfATruncatedFile) {
  bunny_ = large_sample();
  serve();
  connect(kMaxFramePayload, 4096);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  want("");
  EXPECT_EQ(next().type, FrameType::opened);
  std::filesystem::resize_file(running_->directory() / "bunny.pmesh", 1000);
  EXPECT_LT(client_->receive_all().size(), bunny_.bytes.size());
}

TEST_F(TcpSessionTest, DrainEndsIdleConnections) {
  serve();
  connect_and_open();
  running_->server().drain();
  expect_end(FailureCode::shutting_down);
  client_.reset();
  running_->join();
}

TEST_F(TcpSessionTest, DrainLetsTransfersEnd) {
  bunny_ = large_sample();
  serve();
  connect_and_open();
  want("");
  const Frame first = next();
  running_->server().drain();
  EXPECT_EQ(delivery().answer.type, FrameType::done);
  expect_end(FailureCode::shutting_down);
  client_.reset();
  running_->join();
}

TEST_F(TcpSessionTest, RefusesConnectionsBeyondTheLimit) {
  serve([](ServerOptions& options) { options.max_connections = 1; });
  connect();
  const auto first = std::move(client_);
  connect();
  expect_end(FailureCode::busy);
}

}  // namespace
}  // namespace pmesh
