#include <algorithm>
#include <deque>

#include <boost/asio/buffer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "protocol/messages.h"
#include "tests/soak/visit.h"

namespace pmesh::soak {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::use_awaitable;

namespace {

constexpr std::uint64_t kMostWants = 10;

/// What frames travel by.
class TcpWire {
 public:
  explicit TcpWire(Socket socket) : socket_(std::move(socket)) {}

  Socket& socket() { return socket_; }
  asio::awaitable<void> send(const Bytes& frame) {
    co_await asio::async_write(socket_, asio::buffer(frame), use_awaitable);
  }
  /// The next bytes; they are valid until the next call.
  asio::awaitable<ByteView> receive() {
    const std::size_t count = co_await socket_.async_read_some(asio::buffer(held_), use_awaitable);
    co_return ByteView(held_).first(count);
  }

 private:
  Socket socket_;
  Bytes held_ = Bytes(65536);
};

class WebSocketWire {
 public:
  explicit WebSocketWire(Socket socket) : stream_(std::move(socket)) { stream_.binary(true); }

  asio::awaitable<void> shake_hands(const std::string& target) {
    co_await stream_.async_handshake("soak", target, use_awaitable);
  }
  Socket& socket() { return stream_.next_layer(); }
  asio::awaitable<void> send(const Bytes& frame) {
    co_await stream_.async_write(asio::buffer(frame), use_awaitable);
  }
  asio::awaitable<ByteView> receive() {
    held_.clear();
    co_await stream_.async_read(held_, use_awaitable);
    co_return ByteView(static_cast<const std::uint8_t*>(held_.cdata().data()), held_.size());
  }

 private:
  websocket::stream<Socket> stream_;
  boost::beast::flat_buffer held_;
};

/// A want that is not answered yet.
struct PendingWant {
  Resolution level;
  std::uint64_t next = 0;  // the byte that its data go on with
  bool may_be_cancelled = false;
};

/// A conversation about one mesh: every want is answered once, in order, by the file's bytes.
template <class Wire>
class Conversation {
 public:
  Conversation(Visitor& visitor, const SoakMesh& mesh, Wire& wire)
      : visitor_(visitor), mesh_(mesh), wire_(wire) {}

  asio::awaitable<void> run() {
    // Named, because g++ 12 destroys some temporaries of a co_await expression twice.
    const Bytes hello = encode_hello({});
    const Bytes open = encode_open(stream_, {mesh_.id, mesh_.index.header.content_hash});
    co_await wire_.send(hello);
    co_await wire_.send(open);
    for (std::uint64_t left = 1 + below(random(), kMostWants); left > 0 && !over_; --left) {
      co_await want();
      if (once_in(random(), 20)) co_await want();  // replaces the first
      while (!wants_.empty() && !over_) co_await take_some();
    }
  }

 private:
  Random& random() { return visitor_.random; }

  asio::awaitable<void> want() {
    const LodRequest wish = random_wish(random(), mesh_.index);
    const Resolution level = *resolve(wish, mesh_.index);
    const std::uint64_t from = once_in(random(), 3) ? below(random(), mesh_.bytes.size()) : 0;
    for (PendingWant& before : wants_) before.may_be_cancelled = true;
    wants_.push_back({level, std::max(from, level.begin)});
    const Bytes frame = encode_want(stream_, {from, wish});
    co_await wire_.send(frame);
  }

  asio::awaitable<void> take_some() {
    if (once_in(random(), 200)) {
      abort(visitor_, wire_.socket());
      over_ = true;
      co_return;
    }
    co_await meddle();
    ByteView bytes = co_await wire_.receive();
    while (!over_) {
      const FrameStep step = parser_.feed(bytes);
      if (step == FrameStep::more) break;
      if (step == FrameStep::bad) co_return fail("bad frame");
      take(parser_.frame());
    }
  }

  asio::awaitable<void> meddle() {
    Bytes frames;
    switch (below(random(), 60)) {
      case 0:
        frames = encode_empty(FrameType::pause, stream_);
        co_await wire_.send(frames);
        frames = encode_empty(FrameType::resume, stream_);
        break;
      case 1:
        frames = encode_empty(FrameType::ping, 0);
        break;
      case 2:
        for (PendingWant& want : wants_) want.may_be_cancelled = true;
        frames = encode_empty(FrameType::cancel, stream_);
        break;
      default:
        break;
    }
    if (!frames.empty()) co_await wire_.send(frames);
  }

  void take(const Frame& frame) {
    switch (frame.type) {
      case FrameType::data:
        return take_data(frame);
      case FrameType::done:
        return take_done(frame);
      case FrameType::failure:
        return take_failure(frame);
      case FrameType::hello:
      case FrameType::opened:
      case FrameType::pong:
        return;
      default:
        return fail("a frame of type " + std::to_string(static_cast<int>(frame.type)));
    }
  }

  void take_data(const Frame& frame) {
    const auto data = parse_data(frame.payload);
    if (!data || wants_.empty()) return fail("data out of place");
    PendingWant& want = wants_.front();
    const std::uint64_t end = data->offset + data->bytes.size();
    if (data->offset != want.next || end > want.level.end) return fail("data with a gap");
    if (!std::ranges::equal(data->bytes,
                            ByteView(mesh_.bytes).subspan(data->offset, data->bytes.size()))) {
      return fail("wrong bytes");
    }
    want.next = end;
    visitor_.tally.bytes += data->bytes.size();
  }

  void take_done(const Frame& frame) {
    const auto done = parse_done(frame.payload);
    if (!done || wants_.empty()) return fail("done out of place");
    const PendingWant& want = wants_.front();
    if (done->end != want.level.end || done->faces != want.level.faces ||
        want.next < want.level.end) {
      return fail("done too early, or for another wish");
    }
    answered();
  }

  void take_failure(const Frame& frame) {
    const auto failure = parse_failure(frame.payload);
    if (!failure || failure->code != FailureCode::cancelled || wants_.empty() ||
        !wants_.front().may_be_cancelled) {
      return fail("failure: " + (failure ? failure->text : "unreadable"));
    }
    answered();
  }

  void answered() {
    ++visitor_.tally.answers;
    wants_.pop_front();
  }

  void fail(const std::string& what) {
    visitor_.fault(mesh_.id + ": " + what);
    over_ = true;
  }

  Visitor& visitor_;
  const SoakMesh& mesh_;
  Wire& wire_;
  FrameParser parser_;
  const std::uint16_t stream_ = static_cast<std::uint16_t>(1 + below(random(), 65535));
  std::deque<PendingWant> wants_;
  bool over_ = false;
};

}  // namespace

asio::awaitable<void> visit_tcp(Visitor& visitor) {
  Socket socket = co_await connect(visitor, visitor.tcp_port);
  TcpWire wire(std::move(socket));
  Conversation conversation(visitor, visitor.any_mesh(), wire);
  co_await conversation.run();
}

asio::awaitable<void> visit_web_socket(Visitor& visitor) {
  Socket socket = co_await connect(visitor, visitor.http_port);
  WebSocketWire wire(std::move(socket));
  const SoakMesh& mesh = visitor.any_mesh();
  co_await wire.shake_hands("/" + mesh.id + "/stream");
  Conversation conversation(visitor, mesh, wire);
  co_await conversation.run();
}

}  // namespace pmesh::soak
