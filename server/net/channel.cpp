#include "server/net/channel.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <sys/sendfile.h>
#include <sys/socket.h>

namespace pmesh {

namespace asio = boost::asio;
using boost::system::error_code;

namespace {

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);

/// A file is looked at for changes once in so many bytes.
constexpr std::uint64_t kSendFileBytes = 1024 * 1024;

constexpr std::chrono::seconds kLingerTime{1};
constexpr std::size_t kLingerBytes = 256 * 1024;

bool must_wait(int error_number) { return error_number == EAGAIN || error_number == EWOULDBLOCK; }

}  // namespace

Channel::Channel(asio::ip::tcp::socket socket, const SessionLimits& limits)
    : socket_(std::move(socket)),
      executor_(socket_.get_executor()),
      send_timeout_(limits.send_timeout) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  socket_.set_option(asio::socket_base::send_buffer_size(limits.send_buffer_bytes), ignored);
  receive_deadline_ = std::make_shared<Deadline>(executor_, [this] {
    timed_out_ = true;
    interrupt_receive();
  });
  send_deadline_ = std::make_shared<Deadline>(executor_, [this] { reset(); });
}

Channel::~Channel() { close(); }

asio::awaitable<std::size_t> Channel::receive(std::span<char> into,
                                              Deadline::Clock::time_point by) {
  timed_out_ = interrupted_ = false;
  receive_deadline_->set(by);
  error_code error;
  std::size_t count = 0;
  do {  // a wait for the same socket that is cancelled takes this one with it
    std::tie(error, count) =
        co_await socket_.async_read_some(asio::buffer(into.data(), into.size()), kAwait);
  } while (error == asio::error::operation_aborted && socket_.is_open() && !interrupted_);
  receive_deadline_->clear();
  co_return error ? 0 : count;
}

void Channel::interrupt_receive() {
  interrupted_ = true;
  error_code ignored;
  socket_.cancel(ignored);
}

asio::awaitable<bool> Channel::send(ByteView bytes, bool more_follows) {
  bool connected = true;
  while (connected && !bytes.empty()) {
    const ssize_t sent = ::send(socket_.native_handle(), bytes.data(), bytes.size(),
                                MSG_NOSIGNAL | (more_follows ? MSG_MORE : 0));
    if (sent >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (must_wait(errno)) {
      connected = co_await wait_until_writable();
    } else {
      connected = errno == EINTR;
    }
  }
  co_return connected;
}

asio::awaitable<bool> Channel::send_file(const MeshFile& mesh, ByteSpan span) {
  auto offset = static_cast<off_t>(span.begin);
  const auto end = static_cast<off_t>(span.end);
  bool connected = true;
  while (connected && offset < end) {
    if (!mesh.intact()) co_return false;
    const auto count = std::min(static_cast<std::uint64_t>(end - offset), kSendFileBytes);
    const ssize_t sent = ::sendfile(socket_.native_handle(), mesh.descriptor(), &offset, count);
    if (sent == 0) co_return false;  // the file was truncated just now
    if (sent > 0) continue;
    if (must_wait(errno)) {
      connected = co_await wait_until_writable();
    } else {
      connected = errno == EINTR;
    }
  }
  co_return connected;
}

asio::awaitable<bool> Channel::wait_until_writable() {
  send_deadline_->set(Deadline::Clock::now() + send_timeout_);
  error_code error;
  do {
    std::tie(error) = co_await socket_.async_wait(asio::socket_base::wait_write, kAwait);
  } while (error == asio::error::operation_aborted && socket_.is_open());
  send_deadline_->clear();
  co_return !error;
}

asio::awaitable<void> Channel::close_gently() {
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
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace pmesh
