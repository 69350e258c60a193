// What ends a TCP session, or keeps it from beginning.
#include "tests/server/descriptor_limit.h"
#include "tests/server/tcp_session_fixture.h"

namespace pmesh {
namespace {

using namespace std::chrono_literals;
using namespace testing;

class TcpSessionLimitsTest : public testing::TcpSession {};

TEST_F(TcpSessionLimitsTest, HelloMustComeFirstAndOnce) {
  serve();
  connect();
  send(encode_hello({}));
  expect_end(FailureCode::protocol_error);
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  send(encode_empty(FrameType::ping, 0));
  EXPECT_EQ(next().type, FrameType::hello);
  expect_end(FailureCode::protocol_error);
}

TEST_F(TcpSessionLimitsTest, OtherVersionsAreNotSpoken) {
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

TEST_F(TcpSessionLimitsTest, WhatBreaksTheRulesEndsTheConnection) {
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

TEST_F(TcpSessionLimitsTest, HttpOnTheWrongPortIsAnsweredAndClosed) {
  serve();
  client_ = std::make_unique<TestClient>(running_->server().tcp_address());
  client_->send("GET / HTTP/1.1\r\nHost: x\r\n\r\n");
  EXPECT_EQ(next().type, FrameType::hello);
  expect_end(FailureCode::protocol_error);
}

TEST_F(TcpSessionLimitsTest, IdleConnectionsEnd) {
  serve([](ServerOptions& options) { options.limits.idle_timeout = 50ms; });
  connect_and_open();
  expect_end(FailureCode::idle_timeout);
}

TEST_F(TcpSessionLimitsTest, APausedTransferIsIdle) {
  bunny_ = large_sample();
  serve([](ServerOptions& options) { options.limits.idle_timeout = 50ms; });
  connect_and_open();
  want("");
  send(encode_empty(FrameType::pause, 1));
  expect_failure(delivery().answer, 0, FailureCode::idle_timeout);
}

TEST_F(TcpSessionLimitsTest, ResetsAPeerThatDoesNotRead) {
  bunny_ = large_sample();
  serve([](ServerOptions& options) { options.limits.send_timeout = 50ms; });
  connect(kMaxFramePayload, 4096);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  want("");
  client_->wait_for_end();
  EXPECT_LT(client_->receive_all().size(), bunny_.bytes.size());
  EXPECT_TRUE(client_->was_reset());
}

TEST_F(TcpSessionLimitsTest, AFloodOfPingsIsAnsweredPingByPing) {
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

TEST_F(TcpSessionLimitsTest, CutsATransferOfATruncatedFile) {
  bunny_ = large_sample();
  serve();
  connect(kMaxFramePayload, 4096);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  want("");
  EXPECT_EQ(next().type, FrameType::opened);
  std::filesystem::resize_file(running_->directory() / "bunny.pmesh", 1000);
  EXPECT_LT(client_->receive_all().size(), bunny_.bytes.size());
}

TEST_F(TcpSessionLimitsTest, DrainEndsIdleConnections) {
  serve();
  connect_and_open();
  running_->server().drain();
  expect_end(FailureCode::shutting_down);
  client_.reset();
  running_->join();
}

TEST_F(TcpSessionLimitsTest, DrainLetsTransfersEnd) {
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

TEST_F(TcpSessionLimitsTest, RefusesConnectionsBeyondTheLimit) {
  serve([](ServerOptions& options) { options.max_connections = 1; });
  connect();
  const auto first = std::move(client_);
  connect();
  expect_end(FailureCode::busy);
}

}  // namespace
}  // namespace pmesh
