#include "server/frames/tcp_session.h"

#include <algorithm>
#include <array>

#include <boost/asio/co_spawn.hpp>

namespace pmesh {

namespace asio = boost::asio;

namespace {

/// Of the file, in a data frame: few enough that a pause or cancel works soon.
constexpr std::uint64_t kDataBytes = 128 * 1024;
constexpr std::size_t kReceiveBytes = 2048;

Opened opened_from(const MeshFile& mesh) {
  const FileHeader& header = mesh.index().header;
  return {.hash = header.content_hash,
          .file_bytes = header.file_bytes,
          .vertices = header.vertices,
          .faces = header.faces,
          .base_vertices = header.base_vertices,
          .base_faces = header.base_faces,
          .chunks = static_cast<std::uint32_t>(mesh.index().chunks.size())};
}

}  // namespace

TcpSession::TcpSession(asio::ip::tcp::socket socket, const SessionLimits& limits, MeshStore& store)
    : Session(std::move(socket), limits),
      store_(store),
      work_(channel_.executor()),
      room_(channel_.executor()) {
  enqueue(encode_hello({.max_frame = kMinFrameLimit}));  // ahead of whatever a drain may say
}

asio::awaitable<void> TcpSession::run() {
  const auto reader_ended = [this, self = shared_from_this()](const std::exception_ptr& exception) {
    if (exception) log_exception("a session", exception);
    ending_ = true;
    reading_ = false;
    work_.notify();
  };
  asio::co_spawn(channel_.executor(), read_frames(), reader_ended);
  const bool sent_all = co_await write_frames();
  if (!sent_all) channel_.reset();
  writing_ = false;
  room_.notify();
  channel_.interrupt_receive();
  while (reading_) co_await work_.wait();
  co_await channel_.close_gently();
}

void TcpSession::on_drain() {
  if (!is_sending()) end_with(FailureCode::shutting_down, "the server shuts down");
}

// ---- reading

asio::awaitable<void> TcpSession::read_frames() {
  std::array<char, kReceiveBytes> buffer;
  auto by = Deadline::Clock::now() + limits().header_timeout;
  while (!ending_ && writing_) {
    const std::size_t count = co_await channel_.receive(buffer, by);
    if (count > 0) {
      co_await take_frames(as_bytes({buffer.data(), count}));
      if (!parser_.inside_frame()) by = Deadline::Clock::now() + limits().idle_timeout;
    } else if (channel_.timed_out() && is_sending()) {
      by = Deadline::Clock::now() + limits().idle_timeout;
    } else if (channel_.timed_out()) {
      end_with(FailureCode::idle_timeout, "nothing was asked for too long");
    } else {
      ending_ = true;
    }
  }
}

/// Acts on every whole frame; waits while too many answers are not sent yet.
asio::awaitable<void> TcpSession::take_frames(ByteView bytes) {
  while (!ending_ && writing_) {
    if (answer_bytes_ > limits().queued_bytes) {
      co_await room_.wait();
      continue;
    }
    const FrameStep step = parser_.feed(bytes);
    if (step == FrameStep::more) break;
    if (step == FrameStep::bad) {
      end_with(FailureCode::protocol_error, parser_.error());
    } else {
      take_frame(parser_.frame());
    }
  }
}

bool TcpSession::is_sending() const {
  return stream_ && stream_->transfer && !stream_->transfer->paused;
}

void TcpSession::take_frame(const Frame& frame) {
  if ((frame.type == FrameType::hello) == peer_.has_value()) {
    end_with(FailureCode::protocol_error, "hello must be the first message, once");
    return;
  }
  switch (frame.type) {
    case FrameType::hello:
      return take_hello(frame);
    case FrameType::open:
      return take_open(frame);
    case FrameType::want:
      return take_want(frame);
    case FrameType::pause:
    case FrameType::resume:
    case FrameType::cancel:
    case FrameType::ping:
    case FrameType::pong:
      return take_control(frame);
    default:
      end_with(FailureCode::protocol_error, "a client must not send frames of type " +
                                                std::to_string(static_cast<unsigned>(frame.type)));
  }
}

void TcpSession::take_hello(const Frame& frame) {
  const auto hello = parse_hello(frame.payload);
  if (!hello || frame.stream != kConnectionStream) {
    end_with(FailureCode::protocol_error, hello ? "hello: not on stream 0" : hello.error().message);
  } else if (hello->version != kProtocolVersion) {
    end_with(FailureCode::unsupported_version,
             "this server speaks version " + std::to_string(kProtocolVersion));
  } else {
    peer_ = *hello;
  }
}

void TcpSession::take_open(const Frame& frame) {
  const auto open = parse_open(frame.payload);
  if (!open || frame.stream == kConnectionStream) {
    end_with(FailureCode::protocol_error, open ? "open: on stream 0" : open.error().message);
    return;
  }
  if (stream_ && stream_->id != frame.stream) {
    fail(frame.stream, FailureCode::too_many_streams, "one stream can be open on a connection");
    return;
  }
  if (stream_) end_transfer(*stream_, "the stream was opened again");
  stream_.reset();
  open_mesh(frame.stream, *open);
}

void TcpSession::open_mesh(std::uint16_t stream, const Open& open) {
  const auto found = open.hash ? store_.find(open.id, *open.hash) : store_.find(open.id);
  if (!found) return fail(stream, FailureCode::busy, "the mesh cannot be read now");
  if (const MeshPtr& mesh = *found) {
    enqueue(encode_opened(stream, opened_from(*mesh)));
    stream_ = Stream{stream, mesh, {}};
    return;
  }
  const auto current = store_.find(open.id);
  if (open.hash && current && *current) {
    fail(stream, FailureCode::hash_changed, "the mesh has another hash now");
  } else {
    fail(stream, FailureCode::not_found, "no such mesh");
  }
}

void TcpSession::take_want(const Frame& frame) {
  const auto want = parse_want(frame.payload);
  const bool bad_message = !want && want.error().code != ErrorCode::usage;
  if (bad_message || frame.stream == kConnectionStream) {
    end_with(FailureCode::protocol_error, bad_message ? want.error().message : "want: on stream 0");
    return;
  }
  Stream* stream = find_stream(frame.stream);
  if (!stream) return fail(frame.stream, FailureCode::not_open, "no mesh is open on this stream");
  end_transfer(*stream, "another want came");
  if (!want) return fail(frame.stream, FailureCode::bad_wish, want.error().message);

  const auto level = resolve(want->wish, stream->mesh->index());
  if (!level) return fail(frame.stream, FailureCode::bad_wish, level.error().message);
  if (want->from_offset > stream->mesh->file_bytes()) {
    return fail(frame.stream, FailureCode::bad_wish, "want: the offset is beyond the file");
  }
  stream->transfer = Transfer{std::max(want->from_offset, level->begin), *level};
  work_.notify();
}

void TcpSession::take_control(const Frame& frame) {
  if (!frame.payload.empty()) {
    return end_with(FailureCode::protocol_error, "the payload has the wrong size");
  }
  if (frame.type == FrameType::ping) enqueue(encode_empty(FrameType::pong, frame.stream));
  Stream* stream = find_stream(frame.stream);
  if (!stream || !stream->transfer) return;
  if (frame.type == FrameType::pause) stream->transfer->paused = true;
  if (frame.type == FrameType::resume) stream->transfer->paused = false;
  if (frame.type == FrameType::cancel) end_transfer(*stream, "as asked");
  work_.notify();
}

TcpSession::Stream* TcpSession::find_stream(std::uint16_t id) {
  return stream_ && stream_->id == id ? &*stream_ : nullptr;
}

/// Answers the want under way, if there is one, as cancelled.
void TcpSession::end_transfer(Stream& stream, std::string reason) {
  if (!stream.transfer) return;
  stream.transfer.reset();
  fail(stream.id, FailureCode::cancelled, std::move(reason));
}

// ---- writing

/// Runs to the end of the conversation; false if it ended in the middle of what was to be sent.
asio::awaitable<bool> TcpSession::write_frames() {
  bool sent = true;
  while (sent) {
    if (!answers_.empty()) {
      sent = co_await send_next_answer();
    } else if (ending_) {
      co_return true;
    } else if (is_sending()) {
      sent = co_await send_next_data();
    } else if (draining()) {
      end_with(FailureCode::shutting_down, "the server shuts down");
    } else {
      co_await work_.wait();
    }
  }
  co_return false;
}

asio::awaitable<bool> TcpSession::send_next_answer() {
  const Bytes frame = std::move(answers_.front());
  answers_.pop_front();
  answer_bytes_ -= frame.size();
  room_.notify();
  co_return co_await channel_.send(frame);
}

/// Sends one data frame of the transfer; its done follows the last.
asio::awaitable<bool> TcpSession::send_next_data() {
  Transfer& transfer = *stream_->transfer;
  const Resolution level = transfer.level;
  const std::uint64_t begin = transfer.next;
  if (begin >= level.end) {
    enqueue(encode_done(stream_->id, {level.end, level.faces, level.vertices, level.reached}));
    stream_->transfer.reset();
    co_return true;
  }
  const std::uint64_t room = std::min<std::uint64_t>(peer_->max_frame, kMaxFramePayload);
  const std::uint64_t count = std::min({level.end - begin, kDataBytes, room - kDataHeaderBytes});
  transfer.next += count;
  // From here on the reader may end this transfer, and begin another.
  const MeshPtr mesh = stream_->mesh;
  const Bytes header = encode_data_header(stream_->id, begin, count);
  const bool header_sent = co_await channel_.send(header, true);
  if (!header_sent) co_return false;
  co_return co_await channel_.send_file(*mesh, {begin, begin + count});
}

// ---- both

void TcpSession::enqueue(Bytes frame) {
  answer_bytes_ += frame.size();
  answers_.push_back(std::move(frame));
  work_.notify();
}

void TcpSession::fail(std::uint16_t stream, FailureCode code, std::string text) {
  enqueue(encode_failure(stream, {code, std::move(text)}));
}

/// Tells the peer why, and ends the conversation.
void TcpSession::end_with(FailureCode code, std::string text) {
  if (ending_) return;
  fail(kConnectionStream, code, std::move(text));
  ending_ = true;
  channel_.interrupt_receive();
}

}  // namespace pmesh
