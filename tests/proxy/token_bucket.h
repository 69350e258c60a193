// A token bucket: how long bytes must wait so that no more of them pass than a rate allows.
//
// Threads: plain values. Time is given, not read.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace pmesh::test {

class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;

  /// `bits_per_second` 0 is no limit. Up to `burst_bytes` pass at once after a pause.
  TokenBucket(std::uint64_t bits_per_second, std::uint64_t burst_bytes)
      : seconds_per_byte_(bits_per_second == 0 ? 0 : 8.0 / static_cast<double>(bits_per_second)),
        burst_(seconds_per_byte_ * static_cast<double>(burst_bytes)) {}

  /// Takes the tokens of `bytes` and gives the time from which on these may pass. The calls' times
  /// must not fall.
  Clock::time_point take(Clock::time_point now, std::uint64_t bytes) {
    // What has been taken is paid for by time: up to `paid_`, and never long before now.
    paid_ = std::max(paid_, now - std::chrono::duration_cast<Clock::duration>(burst_));
    paid_ += std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(seconds_per_byte_ * static_cast<double>(bytes)));
    return std::max(now, paid_);
  }

 private:
  double seconds_per_byte_;
  std::chrono::duration<double> burst_;
  Clock::time_point paid_{};
};

}  // namespace pmesh::test
