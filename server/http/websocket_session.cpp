#include "server/http/websocket_session.h"

#include <unistd.h>

namespace pmesh {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

namespace {

/// A frame of at most this size is put together in memory, head and bytes.
constexpr std::size_t kPieceBytes = 16 * 1024;

/// For a peer to answer the closing handshake.
constexpr std::chrono::seconds kGoodbyeTime{2};

}  // namespace

WebSocketFrameWire::WebSocketFrameWire(Channel& channel) : channel_(channel), stream_(channel) {
  stream_.read_message_max(kFrameHeaderBytes + kMinFrameLimit);
  stream_.binary(true);
  stream_.auto_fragment(false);
  stream_.set_option(websocket::stream_base::timeout{kGoodbyeTime, websocket::stream_base::none(),
                                                     /*keep_alive_pings=*/false});
}

Awaitable<bool> WebSocketFrameWire::accept(const RequestParser::Message& request) {
  const auto [error] = co_await stream_.async_accept(request, kAwait);
  co_return !error;
}

Awaitable<FrameWire::Arrival> WebSocketFrameWire::next() {
  buffer_.clear();
  const auto [error, count] = co_await stream_.async_read(buffer_, kAwait);
  if (error) co_return Arrival{};  // too long a message has been answered by Beast
  if (!stream_.got_binary()) co_return Arrival{Arrival::bad, "the message is not binary"};
  const auto data = buffer_.cdata();
  ByteView bytes(static_cast<const std::uint8_t*>(data.data()), data.size());
  FrameParser parser(kMinFrameLimit);
  const FrameStep step = parser.feed(bytes);
  if (step == FrameStep::bad) co_return Arrival{Arrival::bad, parser.error()};
  const bool is_one = step == FrameStep::done && bytes.empty();
  if (!is_one) co_return Arrival{Arrival::bad, "the message is not one frame"};
  frame_ = std::move(parser.frame());
  buffer_.clear();
  co_return Arrival{Arrival::frame};
}

/// The closing handshake: the peer's answer to it ends next().
Awaitable<void> WebSocketFrameWire::stop_reading() {
  const auto [error] = co_await stream_.async_close(websocket::close_code::normal, kAwait);
  if (error) channel_.interrupt_receive();
}

Awaitable<bool> WebSocketFrameWire::send(ByteView frame) {
  const auto [error, count] =
      co_await stream_.async_write(asio::buffer(frame.data(), frame.size()), kAwait);
  co_return !error;
}

/// In pieces of one message, so that a connection holds one piece and no more.
Awaitable<bool> WebSocketFrameWire::send_data(ByteView head, const MeshFile& mesh, ByteSpan span) {
  message_.assign(head.begin(), head.end());
  bool sent = true;
  while (sent) {
    const std::size_t held = message_.size();
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(span.size(), kPieceBytes));
    message_.resize(held + count);
    if (!mesh.recently_intact()) break;
    const ssize_t read =
        ::pread(mesh.descriptor(), message_.data() + held, count, static_cast<off_t>(span.begin));
    if (read != static_cast<ssize_t>(count)) break;
    span.begin += count;
    const bool is_last = span.size() == 0;
    const auto [error, written] = co_await stream_.async_write_some(
        is_last, asio::buffer(message_.data(), message_.size()), kAwait);
    sent = !error;
    if (sent && is_last) {
      message_ = Bytes();
      co_return true;
    }
    message_.clear();
  }
  co_return false;
}

Awaitable<void> WebSocketFrameWire::close_gently() {
  channel_.close();
  co_return;
}

Awaitable<void> WebSocketSession::run(const RequestParser::Message& request,
                                      std::shared_ptr<void> owner) {
  const bool accepted = co_await wire_.accept(request);
  if (accepted) co_await conversation_.run(owner);
}

}  // namespace pmesh
