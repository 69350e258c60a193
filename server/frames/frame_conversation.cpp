#include "server/frames/frame_conversation.h"

#include <algorithm>
#include <ctime>
#include <exception>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/this_coro.hpp>

#include "server/log/structured_log.h"
#include "server/net/session.h"

namespace pmesh {

namespace asio = boost::asio;

namespace {

/// Of the file, in a data frame: few enough that a pause or cancel works soon.
constexpr std::uint64_t kDataBytes = 128 * 1024;

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

FrameConversation::FrameConversation(FrameWire& wire, Services& services, PolicyPtr policy,
                                     std::string client, FrameCredentials credentials)
    : wire_(wire),
      services_(services),
      policy_(std::move(policy)),
      client_(std::move(client)),
      credentials_(std::move(credentials)),
      work_(wire.executor()),
      room_(wire.executor()) {
  idle_ = std::make_shared<Deadline>(wire.executor(), [this] { on_idle(); });
  enqueue(encode_hello({.max_frame = kMinFrameLimit}));  // ahead of whatever a drain may say
}

FrameConversation::~FrameConversation() { idle_->stop(); }

Awaitable<void> FrameConversation::run(std::shared_ptr<void> owner) {
  idle_->set(Deadline::Clock::now() + policy_->limits.header_timeout);
  const auto reader_ended = [this, owner](const std::exception_ptr& exception) {
    if (exception) log_exception("a conversation", exception);
    ending_ = true;
    reading_ = false;
    work_.notify();
  };
  asio::co_spawn(wire_.executor(), read_frames(), reader_ended);
  bool sent_all = false;
  try {
    sent_all = co_await write_frames();
  } catch (...) {
    log_exception("a conversation", std::current_exception());
  }
  if (!sent_all) wire_.reset();
  writing_ = false;
  room_.notify();
  co_await wire_.stop_reading();
  while (reading_) co_await work_.wait();
  idle_->stop();
  co_await wire_.close_gently();
}

void FrameConversation::drain() {
  draining_ = true;
  work_.notify();
}

// ---- reading

Awaitable<void> FrameConversation::read_frames() {
  while (!ending_ && writing_) {
    const FrameWire::Arrival arrival = co_await wire_.next();
    if (arrival.kind == FrameWire::Arrival::end) {
      ending_ = true;
    } else if (arrival.kind == FrameWire::Arrival::bad) {
      end_with(FailureCode::protocol_error, arrival.why);
    } else {
      be_patient();
      take_frame(wire_.frame());
      co_await wait_for_room();
    }
  }
}

/// Waits while too many answers are not sent yet.
Awaitable<void> FrameConversation::wait_for_room() {
  if (answer_bytes_ > policy_->limits.queued_bytes) {
    services_.metrics.limits.add(LimitName::queued_bytes);
  }
  while (!ending_ && writing_ && answer_bytes_ > policy_->limits.queued_bytes) {
    co_await room_.wait();
  }
}

void FrameConversation::be_patient() {
  idle_->set(Deadline::Clock::now() + policy_->limits.idle_timeout);
}

/// The peer has said nothing for long: as it should while it is sent to.
void FrameConversation::on_idle() {
  const bool is_sent_to = next_sending() != streams_.end() || !answers_.empty();
  if (peer_ && is_sent_to) return be_patient();
  services_.metrics.limits.add(peer_ ? LimitName::idle_timeout : LimitName::header_timeout);
  end_with(FailureCode::idle_timeout, "nothing was asked for too long");
}

void FrameConversation::take_frame(const Frame& frame) {
  if ((frame.type == FrameType::hello) == peer_.has_value()) {
    end_with(FailureCode::protocol_error, "hello must be the first message, once");
    return;
  }
  switch (frame.type) {
    case FrameType::hello:
      return take_hello(frame);
    case FrameType::authorise:
      return take_authorise(frame);
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

void FrameConversation::take_hello(const Frame& frame) {
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

void FrameConversation::take_authorise(const Frame& frame) {
  if (frame.stream != kConnectionStream) {
    return end_with(FailureCode::protocol_error, "authorise: not on stream 0");
  }
  credentials_.authorization = "Bearer ";
  credentials_.authorization.append(frame.payload.begin(), frame.payload.end());
}

void FrameConversation::take_open(const Frame& frame) {
  auto open = parse_open(frame.payload);
  if (!open || frame.stream == kConnectionStream) {
    end_with(FailureCode::protocol_error, open ? "open: on stream 0" : open.error().message);
    return;
  }
  const auto before = streams_.find(frame.stream);
  if (before == streams_.end() && streams_.size() >= policy_->limits.streams) {
    services_.metrics.limits.add(LimitName::streams);
    fail(frame.stream, FailureCode::too_many_streams,
         std::to_string(streams_.size()) + " streams are open on this connection");
    return;
  }
  if (before != streams_.end()) {
    end_transfer(frame.stream, before->second, "the stream was opened again");
    streams_.erase(before);
  }
  const std::size_t question = open->id.find('?');
  const std::string query = question == std::string::npos ? "" : open->id.substr(question + 1);
  open->id.resize(std::min(question, open->id.size()));
  if (may_open(open->id, query)) return open_mesh(frame.stream, *open);
  services_.metrics.limits.add(LimitName::access);
  fail(frame.stream, FailureCode::not_allowed, "no token or signature allows this mesh");
}

bool FrameConversation::may_open(const std::string& id, const std::string& query) const {
  const bool is_own = query.empty() && id == credentials_.id;
  const auto split = split_query(is_own ? credentials_.query : query);
  if (!split) return false;
  const AccessRequest request{.authorization = credentials_.authorization,
                              .signature = split->signature,
                              .mesh_id = id,
                              .now = static_cast<std::uint64_t>(std::time(nullptr))};
  return services_.policy.get()->access.judge(request) == Access::granted;
}

void FrameConversation::open_mesh(std::uint16_t stream, const Open& open) {
  MeshStore& store = services_.store;
  const auto found = open.hash ? store.find(open.id, *open.hash) : store.find(open.id);
  if (!found) return fail(stream, FailureCode::busy, "the mesh cannot be read now");
  if (const MeshPtr& mesh = *found) {
    enqueue(encode_opened(stream, opened_from(*mesh)));
    streams_[stream] = Stream{mesh, {}};
    return;
  }
  if (!open.hash) return fail(stream, FailureCode::not_found, "no such mesh");
  const auto current = store.find(open.id);
  if (current && *current) {
    fail(stream, FailureCode::hash_changed, "the mesh has another hash now");
  } else {
    fail(stream, FailureCode::not_found, "no such mesh");
  }
}

void FrameConversation::take_want(const Frame& frame) {
  const auto want = parse_want(frame.payload);
  const bool bad_message = !want && want.error().code != ErrorCode::usage;
  if (bad_message || frame.stream == kConnectionStream) {
    end_with(FailureCode::protocol_error, bad_message ? want.error().message : "want: on stream 0");
    return;
  }
  const auto stream = streams_.find(frame.stream);
  if (stream == streams_.end()) {
    return fail(frame.stream, FailureCode::not_open, "no mesh is open on this stream");
  }
  end_transfer(frame.stream, stream->second, "another want came");
  if (!want) return fail(frame.stream, FailureCode::bad_wish, want.error().message);
  begin_transfer(frame.stream, stream->second, *want);
}

void FrameConversation::begin_transfer(std::uint16_t id, Stream& stream, const Want& want) {
  const auto level = resolve(want.wish, stream.mesh->index());
  if (!level) return fail(id, FailureCode::bad_wish, level.error().message);
  if (want.from_offset > stream.mesh->file_bytes()) {
    return fail(id, FailureCode::bad_wish, "want: the offset is beyond the file");
  }
  stream.transfer = Transfer{std::max(want.from_offset, level->begin), *level};
  if (policy_->access_log) {
    const std::string wish = to_query(want.wish);
    log_event(spdlog::level::info, "wanted",
              {{"client", std::string_view(client_)},
               {"mesh", std::string_view(stream.mesh->id())},
               {"wish", std::string_view(wish)},
               {"begin", stream.transfer->next},
               {"end", level->end}});
  }
  work_.notify();
}

void FrameConversation::take_control(const Frame& frame) {
  if (!frame.payload.empty()) {
    return end_with(FailureCode::protocol_error, "the payload has the wrong size");
  }
  if (frame.type == FrameType::ping) enqueue(encode_empty(FrameType::pong, frame.stream));
  const auto found = streams_.find(frame.stream);
  if (found == streams_.end() || !found->second.transfer) return;
  Stream& stream = found->second;
  if (frame.type == FrameType::pause) stream.transfer->paused = true;
  if (frame.type == FrameType::resume) stream.transfer->paused = false;
  if (frame.type == FrameType::cancel) end_transfer(frame.stream, stream, "as asked");
  work_.notify();
}

/// Answers the want under way, if there is one, as cancelled.
void FrameConversation::end_transfer(std::uint16_t id, Stream& stream, std::string reason) {
  if (!stream.transfer) return;
  stream.transfer.reset();
  fail(id, FailureCode::cancelled, std::move(reason));
}

// ---- writing

/// Runs to the end of the conversation; false if it ended in the middle of what was to be sent.
Awaitable<bool> FrameConversation::write_frames() {
  bool sent = true;
  while (sent) {
    const auto stream = next_sending();
    if (!answers_.empty()) {
      sent = co_await send_next_answer();
    } else if (ending_) {
      co_return true;
    } else if (stream != streams_.end()) {
      sent = co_await send_next_data(stream);
    } else if (draining_) {
      end_with(FailureCode::shutting_down, "the server shuts down");
    } else {
      co_await work_.wait();
    }
  }
  co_return false;
}

Awaitable<bool> FrameConversation::send_next_answer() {
  const Bytes frame = std::move(answers_.front());
  answers_.pop_front();
  answer_bytes_ -= frame.size();
  room_.notify();
  const bool sent = co_await wire_.send(frame);
  co_return sent;
}

/// The stream after the one that was served last, going round, that has something to send; the end
/// if none has.
FrameConversation::Streams::iterator FrameConversation::next_sending() {
  const auto is_sending = [](const auto& stream) { return stream.second.is_sending(); };
  const auto behind = streams_.upper_bound(last_sent_);
  const auto found = std::find_if(behind, streams_.end(), is_sending);
  if (found != streams_.end()) return found;
  const auto wrapped = std::find_if(streams_.begin(), behind, is_sending);
  return wrapped == behind ? streams_.end() : wrapped;
}

/// Sends one data frame of the transfer; its done follows the last.
Awaitable<bool> FrameConversation::send_next_data(Streams::iterator stream) {
  Transfer& transfer = *stream->second.transfer;
  last_sent_ = stream->first;
  const Resolution level = transfer.level;
  const std::uint64_t begin = transfer.next;
  if (begin >= level.end) {
    enqueue(encode_done(last_sent_, {level.end, level.faces, level.vertices, level.reached}));
    be_patient();
    stream->second.transfer.reset();
    co_return true;
  }
  const std::uint64_t room = std::min<std::uint64_t>(peer_->max_frame, kMaxFramePayload);
  const std::uint64_t count = std::min({level.end - begin, kDataBytes, room - kDataHeaderBytes});
  transfer.next += count;
  // From here on the reader may end this transfer, and begin another.
  const MeshPtr mesh = stream->second.mesh;
  const Bytes head = encode_data_header(last_sent_, begin, count);
  const ByteSpan span{begin, begin + count};
  const bool sent = co_await wire_.send_data(head, *mesh, span);
  if (!sent && !mesh->intact()) ++services_.metrics.broken_files;
  co_return sent;
}

// ---- both

void FrameConversation::enqueue(Bytes frame) {
  answer_bytes_ += frame.size();
  answers_.push_back(std::move(frame));
  work_.notify();
}

void FrameConversation::fail(std::uint16_t stream, FailureCode code, std::string text) {
  enqueue(encode_failure(stream, {code, std::move(text)}));
}

/// Tells the peer why, and ends the conversation.
void FrameConversation::end_with(FailureCode code, std::string text) {
  if (ending_) return;
  fail(kConnectionStream, code, std::move(text));
  ending_ = true;
}

}  // namespace pmesh
