#include "client/tcp_transport.h"

#include <utility>

namespace pmesh {
namespace {

constexpr std::uint16_t kStream = 1;
constexpr std::size_t kBlockBytes = 64 * 1024;

// Whether a failure may pass when the client comes again.
bool is_retryable(FailureCode code) {
  return code == FailureCode::idle_timeout || code == FailureCode::shutting_down ||
         code == FailureCode::busy || code == FailureCode::cancelled;
}

bool is_done(const Frame& frame) {
  return frame.type == FrameType::done && frame.stream == kStream;
}

}  // namespace

TcpTransport::TcpTransport(TcpMesh mesh, const TransportOptions& options)
    : mesh_(std::move(mesh)), connection_(options), buffer_(kBlockBytes) {}

TransportStatus TcpTransport::open() {
  parser_ = FrameParser();
  unread_ = {};
  if (auto failed = connection_.connect(mesh_.endpoint)) return failed;
  TransportStatus failed = greet();
  if (failed) connection_.close();
  return failed;
}

// Hello and open leave together; the answers come in that order.
TransportStatus TcpTransport::greet() {
  Bytes request = encode_hello({});
  const Bytes open = encode_open(kStream, {mesh_.id, std::nullopt});
  request.insert(request.end(), open.begin(), open.end());
  if (auto failed = send(request)) return failed;
  if (auto failed = expect(FrameType::hello)) return failed;
  const Result<Hello> hello = parse_hello(parser_.frame().payload);
  if (!hello) return broken(hello.error().message);
  if (hello->version != kProtocolVersion) {
    return broken("protocol version " + std::to_string(hello->version) + " is not known");
  }
  if (auto failed = expect(FrameType::opened)) return failed;
  const Result<Opened> opened = parse_opened(parser_.frame().payload);
  if (!opened) return broken(opened.error().message);
  remote_ = {opened->hash, opened->file_bytes};
  return std::nullopt;
}

TransportStatus TcpTransport::read(const ReadRequest& request, const ByteSink& sink) {
  if (!connection_.is_open()) {
    if (auto failed = open()) return failed;
  }
  TransportStatus failed = send(encode_want(kStream, {request.from, request.wish}));
  bool wants_more = true;
  while (!failed && wants_more) {
    failed = next_frame();
    if (failed) break;
    if (is_done(parser_.frame())) return std::nullopt;
    failed = take_data(parser_.frame(), sink, wants_more);
  }
  const bool is_at_end = !failed && !next_frame() && is_done(parser_.frame());
  if (!is_at_end) connection_.close();  // it failed, or it carries data that nobody wants
  return failed;
}

TransportStatus TcpTransport::take_data(const Frame& frame, const ByteSink& sink,
                                        bool& wants_more) {
  if (frame.type != FrameType::data || frame.stream != kStream) return unexpected(frame);
  const Result<Data> data = parse_data(frame.payload);
  if (!data) return broken(data.error().message);
  wants_more = sink(data->offset, data->bytes);
  return std::nullopt;
}

TransportStatus TcpTransport::expect(FrameType type) {
  if (auto failed = next_frame()) return failed;
  const Frame& frame = parser_.frame();
  return frame.type == type ? std::nullopt : unexpected(frame);
}

// Receives up to the next frame that is no ping or pong.
TransportStatus TcpTransport::next_frame() {
  for (;;) {
    const FrameStep step = parser_.feed(unread_);
    if (step == FrameStep::bad) return broken(parser_.error());
    if (step == FrameStep::more) {
      if (auto failed = receive()) return failed;
      continue;
    }
    const FrameType type = parser_.frame().type;
    if (type != FrameType::ping && type != FrameType::pong) return std::nullopt;
    if (type == FrameType::pong) continue;
    if (auto failed = send(encode_empty(FrameType::pong, kConnectionStream))) return failed;
  }
}

TransportStatus TcpTransport::receive() {
  std::size_t count = 0;
  if (auto failed = connection_.read_some(buffer_, count)) return failed;
  unread_ = ByteView(buffer_).first(count);
  if (count > 0) return std::nullopt;
  return retryable_error(
      runtime_error(mesh_.endpoint.text() + ": the connection was closed before the end"));
}

// A frame that does not belong here is a failure that the server tells, or a broken server.
TransportStatus TcpTransport::unexpected(const Frame& frame) const {
  if (frame.type != FrameType::failure) {
    return broken("unexpected frame of type " + std::to_string(static_cast<int>(frame.type)));
  }
  const Result<Failure> failure = parse_failure(frame.payload);
  if (!failure) return broken(failure.error().message);
  const std::string text = mesh_.endpoint.text() + ": " + mesh_.id + ": " + failure->text;
  if (failure->code == FailureCode::bad_wish) return final_error(usage_error(text));
  return TransportError{runtime_error(text), is_retryable(failure->code)};
}

TransportError TcpTransport::broken(const std::string& why) const {
  return final_error(runtime_error(mesh_.endpoint.text() + ": broken protocol: " + why));
}

}  // namespace pmesh
