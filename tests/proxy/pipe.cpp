#include "tests/proxy/pipe.h"

#include <algorithm>
#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

namespace pmesh::test {

namespace asio = boost::asio;

namespace {

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);

// What is under way at most, in bytes: what the link holds at its rate, and something for the peer
// to be slow with.
std::size_t capacity(const PipeOptions& options) {
  constexpr double kSlack = 128 * 1024;
  const double seconds = std::chrono::duration<double>(options.link.delay).count();
  const double held = static_cast<double>(options.bits_per_second) / 8 * seconds;
  const double segments = (kSlack + held) / static_cast<double>(options.link.segment_bytes);
  return static_cast<std::size_t>(segments) + 1;
}

}  // namespace

Pipe::Pipe(Socket& to, const PipeOptions& options, Random random, SharedCounts& counts)
    : to_(to),
      options_(options),
      random_(random),
      counts_(counts),
      bucket_(options.bits_per_second, options.link.segment_bytes),
      inside_(to.get_executor(), capacity(options)) {}

void Pipe::burst_after(std::uint64_t bytes, std::function<void()> burst) {
  left_ = bytes;
  burst_ = std::move(burst);
}

asio::awaitable<bool> Pipe::send(ByteView bytes) {
  while (!bytes.empty()) {
    const ByteView piece = bytes.first(std::min(bytes.size(), options_.link.segment_bytes));
    bytes = bytes.subspan(piece.size());
    co_await wait_until(bucket_.take(Clock::now(), piece.size()));
    Segment segment{Bytes(piece.begin(), piece.end()), due_time()};
    const bool is_in = co_await put(std::move(segment));
    if (!is_in) co_return false;
  }
  co_return true;
}

asio::awaitable<void> Pipe::finish() {
  Segment end{{}, due_time()};
  co_await put(std::move(end));
}

asio::awaitable<bool> Pipe::put(Segment segment) {
  const auto [error] =
      co_await inside_.async_send(boost::system::error_code(), std::move(segment), kAwait);
  co_return !error;
}

// When what is put in now comes out: never before what was put in earlier.
Pipe::Clock::time_point Pipe::due_time() {
  Clock::time_point due = Clock::now() + options_.link.delay;
  if (random_.chance(options_.link.stall_probability)) {
    due += options_.link.stall;
    counts_.add(&ProxyCounts::stalls);
  }
  return last_due_ = std::max(last_due_, due);
}

asio::awaitable<bool> Pipe::deliver() {
  for (;;) {
    const auto [error, segment] = co_await inside_.async_receive(kAwait);
    if (error) co_return false;
    co_await wait_until(segment.due);
    if (segment.bytes.empty()) break;
    const bool is_out = co_await let_out(segment.bytes);
    if (!is_out) {
      inside_.close();
      co_return false;
    }
  }
  boost::system::error_code ignored;
  to_.shutdown(Socket::shutdown_send, ignored);
  co_return true;
}

asio::awaitable<bool> Pipe::let_out(ByteView bytes) {
  bytes = bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), left_)));
  const auto [error, count] =
      co_await asio::async_write(to_, asio::buffer(bytes.data(), bytes.size()), kAwait);
  counts_.add(options_.bytes, count);
  if (error) co_return false;
  if (!burst_) co_return true;
  left_ -= count;
  if (left_ > 0) co_return true;
  burst_();
  co_return false;
}

asio::awaitable<void> Pipe::wait_until(Clock::time_point time) {
  if (time <= Clock::now()) co_return;
  asio::steady_timer timer(to_.get_executor(), time);
  co_await timer.async_wait(kAwait);
}

}  // namespace pmesh::test
