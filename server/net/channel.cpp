#include "server/net/channel.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/sendfile.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/net/address_block.h"

namespace pmesh {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

/// A file is looked at for changes once in so many bytes.
constexpr std::uint64_t kSendFileBytes = 1024 * 1024;

/// After so many bytes others have their turn.
constexpr std::uint64_t kPushBytes = 4 * kSendFileBytes;

/// A peer that makes room so soon, and has taken more than its kernel does for one that does not
/// read, is reading.
constexpr std::uint64_t kMoreThanAKernelTakes = 512 * 1024;
constexpr std::chrono::seconds kLiveWithin{1};

/// Between two looks at whether a slow peer takes anything; sooner if the send timeout is short.
constexpr std::chrono::milliseconds kProgressInterval{1000};

constexpr std::chrono::seconds kLingerTime{1};
constexpr std::size_t kLingerBytes = 256 * 1024;

/// What the result of a system call that sends comes to.
WireStep step_of(ssize_t sent) {
  if (sent > 0) return {WireStep::moved, static_cast<std::size_t>(sent)};
  if (sent == 0) return {};
  if (errno == EAGAIN || errno == EWOULDBLOCK) return {WireStep::must_write, 0};
  return {errno == EINTR ? WireStep::interrupted : WireStep::ended, 0};
}

asio::socket_base::wait_type wait_of(WireStep::Kind need) {
  return need == WireStep::must_read ? asio::socket_base::wait_read : asio::socket_base::wait_write;
}

}  // namespace

Channel::Channel(Socket socket, const SessionLimits& limits)
    : socket_(std::move(socket)),
      executor_(socket_.get_executor()),
      send_timeout_(limits.send_timeout),
      progress_interval_(std::min(limits.send_timeout / 4, kProgressInterval)),
      send_buffer_bytes_(limits.send_buffer_bytes),
      live_send_buffer_bytes_(std::max(limits.send_buffer_bytes, limits.live_send_buffer_bytes)) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  set_send_buffer(send_buffer_bytes_);
  receive_deadline_ = std::make_shared<Deadline>(executor_, [this] {
    timed_out_ = true;
    interrupt_receive();
  });
  send_deadline_ = std::make_shared<Deadline>(executor_, [this] { check_progress(); });
}

Channel::~Channel() { close(); }

asio::ip::address Channel::peer() const {
  error_code ignored;
  return unmapped(socket_.remote_endpoint(ignored).address());
}

Awaitable<bool> Channel::start_tls(const TlsContext& context, Deadline::Clock::time_point by) {
  tls_.emplace(context, socket_.native_handle());
  timed_out_ = interrupted_ = false;
  receive_deadline_->set(by);
  bool may_go_on = true, is_done = false;
  while (may_go_on && !is_done && socket_.is_open() && !interrupted_) {
    const WireStep step = tls_->handshake();
    is_done = step.kind == WireStep::moved;
    may_go_on = step.kind != WireStep::ended;
    if (may_go_on && !is_done) may_go_on = co_await wait_to_receive(step.kind);
  }
  receive_deadline_->clear();
  co_return is_done;
}

// ---- receiving

/// Without TLS one read by Asio takes fewer system calls than a wait and a read.
Awaitable<std::size_t> Channel::receive(std::span<char> into, Deadline::Clock::time_point by) {
  timed_out_ = interrupted_ = false;
  receive_deadline_->set(by);
  std::size_t count = 0;
  error_code error;
  if (tls_) {
    count = co_await receive_decrypted(into);
  } else {
    do {  // a wait for the same socket that is cancelled takes this one with it
      std::tie(error, count) =
          co_await socket_.async_read_some(asio::buffer(into.data(), into.size()), kAwait);
    } while (error == asio::error::operation_aborted && socket_.is_open() && !interrupted_);
  }
  receive_deadline_->clear();
  co_return error ? 0 : count;
}

/// Lets others have their turn first: what is decrypted already needs no wait, and a peer that
/// sends faster than it is answered would have the thread for itself.
Awaitable<std::size_t> Channel::receive_decrypted(std::span<char> into) {
  co_await asio::post(executor_, asio::use_awaitable_t<Executor>());
  bool may_go_on = true;
  while (may_go_on && socket_.is_open() && !interrupted_) {
    const WireStep step = tls_->read(into);
    if (step.kind == WireStep::moved) co_return step.count;
    if (step.kind == WireStep::ended) co_return 0;
    may_go_on = co_await wait_to_receive(step.kind);
  }
  co_return 0;
}

Awaitable<bool> Channel::wait_to_receive(WireStep::Kind need) {
  error_code error;
  do {
    std::tie(error) = co_await socket_.async_wait(wait_of(need), kAwait);
  } while (error == asio::error::operation_aborted && socket_.is_open() && !interrupted_);
  co_return !error;
}

void Channel::interrupt_receive() {
  interrupted_ = true;
  error_code ignored;
  socket_.cancel(ignored);
}

Awaitable<bool> Channel::wait_for_bytes(Deadline::Clock::time_point by) {
  timed_out_ = interrupted_ = false;
  receive_deadline_->set(by);
  const bool arrived = co_await wait_to_receive(WireStep::must_read);
  receive_deadline_->clear();
  co_return arrived;
}

std::span<char> Channel::peek(std::span<char> into) {
  const ssize_t count =
      ::recv(socket_.native_handle(), into.data(), into.size(), MSG_PEEK | MSG_DONTWAIT);
  return into.first(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
}

// ---- sending

/// The head is held back (MSG_MORE) until a file's first bytes can go with it.
WireStep Channel::write(const Parcel& parcel) {
  const bool has_file = parcel.span.size() > 0;
  if (!parcel.head.empty()) {
    return step_of(::send(socket_.native_handle(), parcel.head.data(), parcel.head.size(),
                          MSG_NOSIGNAL | (has_file ? MSG_MORE : 0)));
  }
  if (!parcel.mesh->recently_intact()) return {};
  auto offset = static_cast<off_t>(parcel.span.begin);
  return step_of(::sendfile(socket_.native_handle(), parcel.mesh->descriptor(), &offset,
                            std::min(parcel.span.size(), kSendFileBytes)));
}

/// As much of head and file as one record takes. A record that could not be sent at once is made
/// again, the same, for the next try: so no connection holds a buffer.
WireStep Channel::write_record(const Parcel& parcel) {
  thread_local std::array<std::uint8_t, TlsStream::kRecordBytes> record;
  const std::size_t from_head = std::min(parcel.head.size(), record.size());
  std::copy_n(parcel.head.begin(), from_head, record.begin());
  const auto from_file = static_cast<std::size_t>(
      std::min<std::uint64_t>(record.size() - from_head, parcel.span.size()));
  if (from_file > 0) {
    if (!parcel.mesh->recently_intact()) return {};
    const ssize_t read = ::pread(parcel.mesh->descriptor(), record.data() + from_head, from_file,
                                 static_cast<off_t>(parcel.span.begin));
    if (read != static_cast<ssize_t>(from_file)) return {};  // the file was truncated just now
  }
  return tls_->write(ByteView(record).first(from_head + from_file));
}

WireStep::Kind Channel::push(Parcel& parcel) {
  const std::uint64_t enough = sent_bytes_ + kPushBytes;
  while (!parcel.empty()) {
    if (!socket_.is_open()) return WireStep::ended;
    if (sent_bytes_ >= enough) return WireStep::must_write;
    const WireStep step = tls_ ? write_record(parcel) : write(parcel);
    if (step.kind == WireStep::interrupted) continue;
    if (step.kind != WireStep::moved) return step.kind;
    sent_bytes_ += step.count;
    const std::size_t from_head = std::min(step.count, parcel.head.size());
    const bool is_full =
        !tls_ && from_head == 0 && step.count < std::min(parcel.span.size(), kSendFileBytes);
    parcel.head = parcel.head.subspan(from_head);
    parcel.span.begin += step.count - from_head;
    if (is_full) return WireStep::must_write;  // a second try would only be told so
  }
  return WireStep::moved;
}

Awaitable<bool> Channel::send(Parcel parcel) {
  const WireStep::Kind need = push(parcel);
  return send_rest(parcel, need);
}

Awaitable<bool> Channel::send_rest(Parcel parcel, WireStep::Kind need) {
  bool connected = true;
  while (connected && need != WireStep::moved) {
    connected = co_await wait_to_send(need);
    if (connected) need = push(parcel);
  }
  co_return connected;
}

/// Waits until a step that could not be made can be; false if it never can.
Awaitable<bool> Channel::wait_to_send(WireStep::Kind need) {
  if (need == WireStep::ended || !socket_.is_open()) co_return false;
  const auto begun = Deadline::Clock::now();
  expect_progress();
  error_code error;
  do {
    std::tie(error) = co_await socket_.async_wait(wait_of(need), kAwait);
  } while (error == asio::error::operation_aborted && socket_.is_open());
  send_deadline_->clear();
  const bool is_live = Deadline::Clock::now() - begun < kLiveWithin && has_read();
  if (!error) set_send_buffer(is_live ? live_send_buffer_bytes_ : send_buffer_bytes_);
  co_return !error;
}

/// Whether the peer has taken more than its kernel does by itself. What it was seen to have taken
/// once, it has.
bool Channel::has_read() {
  if (send_buffer_ == live_send_buffer_bytes_) return true;
  return sent_bytes_ >= static_cast<std::uint64_t>(unsent_bytes()) + kMoreThanAKernelTakes;
}

/// From now on the peer has the send timeout to take a byte. The socket becomes writable only when
/// a third of its buffer is free, which a slow reader may need longer for: so the queue is looked
/// at, first for how much there is (most waits end before).
void Channel::expect_progress() {
  unsent_ = 0;
  progressed_ = Deadline::Clock::now();
  send_deadline_->set(progressed_ + progress_interval_);
}

void Channel::check_progress() {
  const int unsent = unsent_bytes();
  const auto now = Deadline::Clock::now();
  if (unsent < unsent_) progressed_ = now;
  unsent_ = unsent;
  if (now - progressed_ >= send_timeout_) {
    send_timed_out_ = true;
    reset();
  } else {
    send_deadline_->set(std::min(now + progress_interval_, progressed_ + send_timeout_));
  }
}

/// Sent to the kernel and not acknowledged by the peer's.
int Channel::unsent_bytes() {
  int unsent = 0;
  return ::ioctl(socket_.native_handle(), SIOCOUTQ, &unsent) == 0 ? unsent : 0;
}

/// What is queued already stays when the buffer shrinks.
void Channel::set_send_buffer(int bytes) {
  if (bytes == send_buffer_) return;
  send_buffer_ = bytes;
  error_code ignored;
  socket_.set_option(asio::socket_base::send_buffer_size(bytes), ignored);
}

// ---- the end

Awaitable<void> Channel::close_gently() {
  if (tls_) tls_->say_goodbye();
  // Closing a socket with unread bytes resets the connection, and the answer with it.
  error_code ignored;
  socket_.shutdown(asio::socket_base::shutdown_send, ignored);
  std::array<char, 4096> unread;
  const auto by = Deadline::Clock::now() + kLingerTime;
  for (std::size_t total = 0; total < kLingerBytes;) {
    const std::size_t count = co_await receive(unread, by);
    if (count == 0) break;
    total += count;
  }
  close();
}

void Channel::reset() {
  error_code ignored;
  socket_.set_option(asio::socket_base::linger(true, 0), ignored);
  close();
}

void Channel::close() {
  receive_deadline_->stop();
  send_deadline_->stop();
  tls_.reset();  // which would write to whoever gets the descriptor next
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace pmesh
