// One direction of a proxied connection: bytes go in, and come out late, at the link's rate and
// with its stalls, until the pipe bursts.
//
// Threads: belongs to the thread that runs its socket.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/experimental/channel.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "core/base/bytes.h"
#include "tests/proxy/random.h"
#include "tests/proxy/shared_counts.h"
#include "tests/proxy/token_bucket.h"

namespace pmesh::test {

struct PipeOptions {
  std::uint64_t bits_per_second = 0;  ///< 0 is no limit.
  LinkOptions link;                   ///< Its rates aside.
  std::uint64_t ProxyCounts::*bytes;  ///< Counts what comes out.
};

class Pipe {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using Clock = std::chrono::steady_clock;

  /// Comes out at `to`; stalls are `random`'s. All must outlive the pipe.
  Pipe(Socket& to, const PipeOptions& options, Random random, SharedCounts& counts);

  /// After so many bytes have come out, `burst` is called once and nothing comes out any more.
  void burst_after(std::uint64_t bytes, std::function<void()> burst);

  /// Puts bytes in; waits while the pipe is full. False if nothing can come out any more.
  boost::asio::awaitable<bool> send(ByteView bytes);

  /// Nothing more will be put in: when all has come out, the peer is told so.
  boost::asio::awaitable<void> finish();

  /// Lets bytes out until finish() or a burst, or until the peer is gone, which gives false. To be
  /// run beside the sender.
  boost::asio::awaitable<bool> deliver();

 private:
  struct Segment {
    Bytes bytes;  // empty: the end
    Clock::time_point due;
  };

  boost::asio::awaitable<void> wait_until(Clock::time_point time);
  boost::asio::awaitable<bool> put(Segment segment);
  boost::asio::awaitable<bool> let_out(ByteView bytes);
  Clock::time_point due_time();

  Socket& to_;
  PipeOptions options_;
  Random random_;
  SharedCounts& counts_;
  TokenBucket bucket_;
  Clock::time_point last_due_{};
  std::uint64_t left_ = UINT64_MAX;  // bytes until it bursts
  std::function<void()> burst_;
  boost::asio::experimental::channel<void(boost::system::error_code, Segment)> inside_;
};

}  // namespace pmesh::test
