#include "server/frames/tcp_session.h"

namespace pmesh {

namespace asio = boost::asio;

Awaitable<FrameWire::Arrival> ChannelFrameWire::next() {
  while (!interrupted_) {
    const FrameStep step = parser_.feed(unread_);
    if (step == FrameStep::done) co_return Arrival{Arrival::frame};
    if (step == FrameStep::bad) co_return Arrival{Arrival::bad, parser_.error()};
    const std::size_t count =
        co_await channel_.receive(buffer_, Deadline::Clock::time_point::max());
    if (count == 0) break;
    unread_ = as_bytes({buffer_.data(), count});
  }
  co_return Arrival{};
}

Awaitable<void> ChannelFrameWire::stop_reading() {
  interrupted_ = true;
  channel_.interrupt_receive();
  co_return;
}

std::string TcpSession::refusal_text() {
  Bytes frames = encode_hello({.max_frame = kMinFrameLimit});
  const Bytes busy = encode_failure(kConnectionStream, {FailureCode::busy, "too many connections"});
  frames.insert(frames.end(), busy.begin(), busy.end());
  return {frames.begin(), frames.end()};
}

Awaitable<void> TcpSession::run() {
  conversation_.emplace(wire_, services(), policy_pointer(), client().to_string());
  if (draining()) conversation_->drain();
  const std::shared_ptr<void> owner = shared_from_this();
  co_await conversation_->run(owner);
}

void TcpSession::on_drain() {
  if (conversation_) conversation_->drain();
}

}  // namespace pmesh
