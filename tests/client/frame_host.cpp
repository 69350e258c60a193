#include "tests/client/frame_host.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <unistd.h>

#include "tests/client/sample.h"

namespace pmesh::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

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

using WebSocket = beast::websocket::stream<tcp::socket, false>;

// False when nothing more may be sent: the rest of the frame that is cut never comes.
bool send(WebSocket& socket, const FrameHost::Answer& answer) {
  std::size_t allowed = answer.allowed;
  for (const Bytes& frame : answer.frames) {
    const std::size_t count = std::min(allowed, frame.size());
    error_code error;
    socket.write_some(count == frame.size(), asio::buffer(frame.data(), count), error);
    if (error || count < frame.size()) return false;
    allowed -= count;
  }
  return true;
}

}  // namespace

FrameHost::FrameHost(FrameBehaviour behaviour, Bytes file)
    : file_(std::move(file)), behaviour_(std::move(behaviour)) {}

FrameHost::Answer FrameHost::answer(const Frame& frame) {
  switch (frame.type) {
    case FrameType::hello:
      return {{encode_hello({})}};
    case FrameType::authorise:
      opened_.push_back("token " + std::string(frame.payload.begin(), frame.payload.end()));
      return {};
    case FrameType::open:
      opened_.push_back(parse_open(frame.payload)->id);
      if (!behaviour_.instead_of_opened.empty()) return {{behaviour_.instead_of_opened}};
      return {{encode_opened(frame.stream, opened_sample())}};
    case FrameType::want:
      return answer_want(frame);
    default:
      return {};
  }
}

FrameHost::Answer FrameHost::answer_want(const Frame& frame) {
  wants_.push_back(*parse_want(frame.payload));
  if (behaviour_.stalls > 0) {
    --behaviour_.stalls;
    return {};
  }
  Answer answer;
  if (behaviour_.cut_after) answer.allowed = behaviour_.cut_after();
  if (!behaviour_.instead_of_data.empty()) {
    answer.frames = {behaviour_.instead_of_data};
    return answer;
  }
  if (!behaviour_.before_data.empty()) answer.frames.push_back(behaviour_.before_data);
  const Resolution lod = *resolve(wants_.back().wish, sample_index());
  for (std::uint64_t at = wants_.back().from_offset; at < lod.end; at += behaviour_.data_bytes) {
    const std::uint64_t count = std::min<std::uint64_t>(behaviour_.data_bytes, lod.end - at);
    answer.frames.push_back(encode_data(frame.stream, {at, ByteView(file_).subspan(at, count)}));
  }
  answer.frames.push_back(
      encode_done(frame.stream, {lod.end, lod.faces, lod.vertices, lod.reached}));
  return answer;
}

FrameServer::FrameServer(FrameBehaviour behaviour)
    : FrameServer(std::move(behaviour), sample_file()) {}

FrameServer::FrameServer(FrameBehaviour behaviour, Bytes file)
    : host_(std::move(behaviour), std::move(file)), server_([this](Peer& peer) { serve(peer); }) {}

void FrameServer::serve(Peer& peer) {
  FrameParser parser;
  for (Bytes bytes = peer.receive(); !bytes.empty(); bytes = peer.receive()) {
    ByteView unread = bytes;
    while (parser.feed(unread) == FrameStep::done) {
      const FrameHost::Answer answer = host_.answer(parser.frame());
      Bytes together;
      for (const Bytes& frame : answer.frames) {
        together.insert(together.end(), frame.begin(), frame.end());
      }
      peer.send(ByteView(together).first(std::min(answer.allowed, together.size())));
      if (answer.allowed < together.size()) return;
    }
  }
}

WebSocketServer::WebSocketServer(FrameBehaviour behaviour, std::string raw)
    : host_(std::move(behaviour), sample_file()),
      raw_(std::move(raw)),
      server_([this](Peer& peer) { serve(peer); }) {}

void WebSocketServer::serve(Peer& peer) {
  asio::io_context context;
  tcp::socket plain(context, tcp::v4(), ::dup(peer.descriptor()));
  beast::flat_buffer buffer;
  beast::http::request<beast::http::empty_body> upgrade;
  error_code error;
  beast::http::read(plain, buffer, upgrade, error);
  if (error) return;
  std::ostringstream text;
  text << upgrade;
  requests_.push_back(text.str());

  WebSocket socket(std::move(plain));
  socket.accept(upgrade, error);
  socket.binary(true);
  socket.auto_fragment(false);
  if (!raw_.empty()) asio::write(socket.next_layer(), asio::buffer(raw_), error);
  while (!error) {
    buffer.clear();
    socket.read(buffer, error);
    if (error) return;
    ByteView unread(static_cast<const std::uint8_t*>(buffer.data().data()), buffer.size());
    FrameParser parser;
    const bool is_frame = parser.feed(unread) == FrameStep::done;
    if (!is_frame || !unread.empty() || !socket.got_binary()) was_one_frame_a_message_ = false;
    if (!raw_.empty()) continue;
    if (!is_frame || !send(socket, host_.answer(parser.frame()))) return;
  }
}

}  // namespace pmesh::test
