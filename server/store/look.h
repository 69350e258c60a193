// Says when it is time to look at a file again.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

#include <time.h>

namespace pmesh {

/// Spares a system call where thousands a second would tell the same. Costs a coarse clock's time.
/// Threads: all members may be called at the same time.
class Look {
 public:
  /// True at first, and then once in every `interval`: look now.
  bool is_due(std::chrono::milliseconds interval) const {
    const std::int64_t now = coarse_now();
    if (now - last_.load(std::memory_order_relaxed) < interval.count() * 1'000'000) return false;
    last_.store(now, std::memory_order_relaxed);
    return true;
  }

 private:
  /// In nanoseconds, good to a few milliseconds.
  static std::int64_t coarse_now() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
    return now.tv_sec * 1'000'000'000 + now.tv_nsec;
  }

  mutable std::atomic<std::int64_t> last_ = INT64_MIN / 2;
};

}  // namespace pmesh
