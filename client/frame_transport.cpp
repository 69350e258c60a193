#include "client/frame_transport.h"

#include <utility>
#include <vector>

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

FrameTransport::FrameTransport(std::unique_ptr<FrameWire> wire, std::string id, std::string token)
    : wire_(std::move(wire)), id_(std::move(id)), token_(std::move(token)), buffer_(kBlockBytes) {}

TransportStatus FrameTransport::open() {
  parser_ = FrameParser();
  unread_ = {};
  if (auto failed = wire_->connect()) return failed;
  TransportStatus failed = greet();
  if (failed) wire_->close();
  return failed;
}

// Hello, token and open leave together; hello and open are answered, in that order.
TransportStatus FrameTransport::greet() {
  std::vector<Bytes> request = {encode_hello({})};
  if (!token_.empty()) request.push_back(encode_authorise(token_));
  request.push_back(encode_open(kStream, {id_, std::nullopt}));
  if (auto failed = wire_->send(request)) return failed;
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

TransportStatus FrameTransport::read(const ReadRequest& request, const ByteSink& sink) {
  if (!wire_->is_open()) {
    if (auto failed = open()) return failed;
  }
  TransportStatus failed = converse(request, sink);
  if (failed) wire_->close();
  return failed;
}

// One want, up to its answer; up to the sink's no if that comes first.
TransportStatus FrameTransport::converse(const ReadRequest& request, const ByteSink& sink) {
  const Bytes want[] = {encode_want(kStream, {request.from, request.wish})};
  if (auto failed = wire_->send(want)) return failed;
  for (bool wants_more = true; wants_more;) {
    if (auto failed = next_frame()) {
      if (failed->retryable) take_unfinished(sink);
      return failed;
    }
    if (is_done(parser_.frame())) return std::nullopt;
    if (auto failed = take_data(parser_.frame(), sink, wants_more)) return failed;
  }
  // If that was not the end, the connection carries data that nobody wants.
  if (next_frame() || !is_done(parser_.frame())) wire_->close();
  return std::nullopt;
}

TransportStatus FrameTransport::take_data(const Frame& frame, const ByteSink& sink,
                                          bool& wants_more) {
  if (frame.type != FrameType::data || frame.stream != kStream) return unexpected(frame);
  const Result<Data> data = parse_data(frame.payload);
  if (!data) return broken(data.error().message);
  wants_more = sink(data->offset, data->bytes);
  return std::nullopt;
}

void FrameTransport::take_unfinished(const ByteSink& sink) {
  const Frame* frame = parser_.unfinished();
  if (frame == nullptr || frame->type != FrameType::data || frame->stream != kStream) return;
  const Result<Data> data = parse_data(frame->payload);
  if (data) sink(data->offset, data->bytes);
}

TransportStatus FrameTransport::expect(FrameType type) {
  if (auto failed = next_frame()) return failed;
  const Frame& frame = parser_.frame();
  return frame.type == type ? std::nullopt : unexpected(frame);
}

// Receives up to the next frame that is no ping or pong.
TransportStatus FrameTransport::next_frame() {
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
    const Bytes pong[] = {encode_empty(FrameType::pong, kConnectionStream)};
    if (auto failed = wire_->send(pong)) return failed;
  }
}

TransportStatus FrameTransport::receive() {
  std::size_t count = 0;
  if (auto failed = wire_->receive(buffer_, count)) return failed;
  unread_ = ByteView(buffer_).first(count);
  if (count > 0) return std::nullopt;
  return retryable_error(
      runtime_error(wire_->peer() + ": the connection was closed before the end"));
}

// A frame that does not belong here is a failure that the server tells, or a broken server.
TransportStatus FrameTransport::unexpected(const Frame& frame) const {
  if (frame.type != FrameType::failure) {
    return broken("unexpected frame of type " + std::to_string(static_cast<int>(frame.type)));
  }
  const Result<Failure> failure = parse_failure(frame.payload);
  if (!failure) return broken(failure.error().message);
  const std::string text = wire_->peer() + ": " + id_ + ": " + failure->text;
  if (failure->code == FailureCode::bad_wish) return final_error(usage_error(text));
  return TransportError{runtime_error(text), is_retryable(failure->code)};
}

TransportError FrameTransport::broken(const std::string& why) const {
  return final_error(runtime_error(wire_->peer() + ": broken protocol: " + why));
}

}  // namespace pmesh
