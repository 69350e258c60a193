// A TCP session through real sockets: a server and one client that speaks frames.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh::testing {

inline std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// What came of one want: the data, put together, and the frame that answered it.
struct Delivery {
  std::uint64_t begin = 0;
  std::string bytes;
  Frame answer;

  Done done() const { return parse_done(answer.payload).value(); }
};

class TcpSession : public ::testing::Test {
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

inline SampleFile large_sample() { return make_sample({8'000'000, 8'000'000}); }

}  // namespace pmesh::testing
