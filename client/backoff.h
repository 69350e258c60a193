// How long to wait before asking again: longer after every failure in a row, as long as the host
// asks for, and never quite the same, so that clients cut off together do not come back together.
//
// Threads: belongs to one thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <random>

namespace pmesh {

struct RetryPolicy {
  /// Retryable failures in a row, without one new byte between them, after which to give up.
  int max_failures = 5;
  /// The wait before the first retry; doubled for every next one in a row. What is waited is from
  /// half of that to all of it.
  std::chrono::milliseconds first_delay{200};
  std::chrono::milliseconds longest_delay{5000};
  /// The most of a host's own demand (Retry-After) that is heeded.
  std::chrono::milliseconds longest_retry_after{30'000};
  /// Of the random part; if none, another one for every fetch.
  std::optional<std::uint32_t> seed;
};

class Backoff {
 public:
  explicit Backoff(const RetryPolicy& policy);

  /// The next wait; `retry_after` is what the host asks for, if it does.
  std::chrono::milliseconds next(std::optional<std::chrono::milliseconds> retry_after);

  /// Something has come: the next failure is a first one again.
  void reset() { delay_ = policy_.first_delay; }

 private:
  RetryPolicy policy_;
  std::chrono::milliseconds delay_;
  std::mt19937 random_;
};

}  // namespace pmesh
