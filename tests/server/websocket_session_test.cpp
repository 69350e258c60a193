// Frames over a WebSocket, with Beast's client.
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <gtest/gtest.h>

#include "protocol/messages.h"
#include "server/access/signed_query.h"
#include "tests/server/running_server.h"
#include "tests/server/sample_file.h"

namespace pmesh {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using testing::make_sample;
using testing::RunningServer;
using testing::SampleFile;

class WebSocketSessionTest : public ::testing::Test {
 protected:
  void serve(const std::function<void(ServerOptions&)>& adjust = {}) {
    running_ = std::make_unique<RunningServer>(adjust);
    running_->directory().write("bunny.pmesh", bunny_.bytes);
  }

  /// False if the server refuses.
  bool connect(const std::string& target = "/bunny/stream") {
    stream_.emplace(context_);
    const std::string address = running_->server().http_address();
    const int port = std::stoi(address.substr(address.rfind(':') + 1));
    stream_->next_layer().connect(
        {asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
    boost::system::error_code error;
    stream_->handshake("localhost", target, error);
    stream_->binary(true);
    return !error;
  }
  void connect_and_open() {
    ASSERT_TRUE(connect());
    send(encode_hello({}));
    EXPECT_EQ(next().type, FrameType::hello);
    send(encode_open(1, {.id = "bunny", .hash = {}}));
    EXPECT_EQ(next().type, FrameType::opened);
  }

  void send(const Bytes& message) { stream_->write(asio::buffer(message.data(), message.size())); }

  /// The frame of the next message; one of type 0 at the end.
  Frame next() {
    boost::beast::flat_buffer buffer;
    boost::system::error_code error;
    stream_->read(buffer, error);
    end_ = error;
    if (error) return {};
    EXPECT_TRUE(stream_->got_binary());
    ByteView bytes(static_cast<const std::uint8_t*>(buffer.cdata().data()), buffer.size());
    FrameParser parser;
    EXPECT_EQ(parser.feed(bytes), FrameStep::done);
    EXPECT_TRUE(bytes.empty());
    return parser.frame();
  }

  std::string delivered() {
    std::string received;
    for (Frame frame = next(); frame.type != FrameType::done; frame = next()) {
      EXPECT_EQ(frame.type, FrameType::data);
      if (frame.type != FrameType::data) break;
      const Data data = parse_data(frame.payload).value();
      EXPECT_EQ(data.offset, received.size());
      received.append(data.bytes.begin(), data.bytes.end());
    }
    return received;
  }

  void expect_failure(std::uint16_t stream, FailureCode code) {
    const Frame frame = next();
    ASSERT_EQ(frame.type, FrameType::failure);
    EXPECT_EQ(frame.stream, stream);
    EXPECT_EQ(parse_failure(frame.payload).value().code, code);
  }

  SampleFile bunny_ = make_sample();
  std::unique_ptr<RunningServer> running_;
  asio::io_context context_;
  std::optional<websocket::stream<asio::ip::tcp::socket>> stream_;
  boost::system::error_code end_;
};

TEST_F(WebSocketSessionTest, SendsAWishAndThenAnother) {
  serve();
  connect_and_open();
  send(encode_want(1, {0, parse_wish("bytes=700").value()}));
  const std::string begin = delivered();
  EXPECT_FALSE(begin.empty());
  send(encode_want(1, {0, {}}));
  EXPECT_EQ(delivered(), bunny_.text());
}

TEST_F(WebSocketSessionTest, SendsALargeFileWhole) {
  bunny_ = make_sample({8'000'000, 8'000'000});
  serve();
  connect_and_open();
  send(encode_want(1, {0, {}}));
  EXPECT_TRUE(delivered() == bunny_.text());
}

TEST_F(WebSocketSessionTest, AMessageIsOneFrame) {
  serve();
  for (Bytes message : {Bytes{1, 2, 3}, Bytes(2000, 0), [] {
                          Bytes two = encode_empty(FrameType::ping, 0);
                          two.insert(two.end(), two.begin(), two.end());
                          return two;
                        }()}) {
    connect_and_open();
    send(message);
    const Frame frame = next();  // too long a message is not even answered
    if (message.size() < kMinFrameLimit) {
      ASSERT_EQ(frame.type, FrameType::failure);
      EXPECT_EQ(parse_failure(frame.payload).value().code, FailureCode::protocol_error);
    } else {
      EXPECT_EQ(frame.type, FrameType{});
    }
  }
}

TEST_F(WebSocketSessionTest, TextIsNotSpoken) {
  serve();
  connect_and_open();
  stream_->text(true);
  stream_->write(asio::buffer(std::string("hello")));
  expect_failure(kConnectionStream, FailureCode::protocol_error);
  EXPECT_EQ(next().type, FrameType{});
  EXPECT_EQ(end_, websocket::error::closed);
}

TEST_F(WebSocketSessionTest, DrainSaysGoodbye) {
  serve();
  connect_and_open();
  running_->server().drain();
  expect_failure(kConnectionStream, FailureCode::shutting_down);
  EXPECT_EQ(next().type, FrameType{});
  EXPECT_EQ(end_, websocket::error::closed);
  stream_.reset();
  running_->join();
}

TEST_F(WebSocketSessionTest, TheClientMayClose) {
  serve();
  connect_and_open();
  boost::system::error_code error;
  stream_->close(websocket::close_code::normal, error);
  EXPECT_FALSE(error);
}

TEST_F(WebSocketSessionTest, ItsUrlMayBeSigned) {
  const std::string key(32, 'k');
  serve([&](ServerOptions& options) { options.access.url_key = key; });
  EXPECT_FALSE(connect());
  EXPECT_TRUE(connect("/bunny/stream?" + sign_query(key, "bunny", std::time(nullptr) + 100)));
  send(encode_hello({}));
  EXPECT_EQ(next().type, FrameType::hello);
  send(encode_open(1, {.id = "bunny", .hash = {}}));
  EXPECT_EQ(next().type, FrameType::opened);
  send(encode_open(2, {.id = "other", .hash = {}}));
  expect_failure(2, FailureCode::not_allowed);
}

TEST_F(WebSocketSessionTest, NobodyTalksBeforeItStands) {
  serve();
  testing::TestClient client(running_->server().http_address());
  const std::string fields =
      "Connection: upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  client.send(testing::get_request("/bunny/stream", fields) + testing::get_request("/health"));
  EXPECT_EQ(testing::read_response(client).status, 400);
  EXPECT_EQ(client.receive_all(), "");
}

TEST_F(WebSocketSessionTest, IdleOnesEnd) {
  serve(
      [](ServerOptions& options) { options.limits.idle_timeout = std::chrono::milliseconds(50); });
  connect_and_open();
  expect_failure(kConnectionStream, FailureCode::idle_timeout);
}

}  // namespace
}  // namespace pmesh
