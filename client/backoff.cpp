#include "client/backoff.h"

#include <algorithm>

namespace pmesh {

Backoff::Backoff(const RetryPolicy& policy)
    : policy_(policy),
      delay_(policy.first_delay),
      random_(policy.seed ? *policy.seed : std::random_device{}()) {}

std::chrono::milliseconds Backoff::next(std::optional<std::chrono::milliseconds> retry_after) {
  const auto half = static_cast<std::uint64_t>(delay_.count()) / 2;
  const std::chrono::milliseconds wait =
      delay_ - std::chrono::milliseconds(static_cast<std::int64_t>(random_() % (half + 1)));
  delay_ = std::min(2 * delay_, policy_.longest_delay);
  return std::max(wait, std::min(retry_after.value_or(wait), policy_.longest_retry_after));
}

}  // namespace pmesh
