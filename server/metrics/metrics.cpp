#include "server/metrics/metrics.h"

#include <algorithm>

namespace pmesh {

void RequestCounts::add(RouteName route, int status) {
  const auto* found = std::find(kStatuses.begin(), kStatuses.end(), status);
  const auto index = found == kStatuses.end() ? 0 : found - kStatuses.begin();
  numbers_.add(static_cast<std::size_t>(route) * kStatuses.size() + static_cast<std::size_t>(index),
               1);
}

void DurationHistogram::add(std::chrono::steady_clock::duration duration) {
  const double seconds = std::chrono::duration<double>(duration).count();
  const auto bucket = std::lower_bound(kBounds.begin(), kBounds.end(), seconds) - kBounds.begin();
  numbers_.add(static_cast<std::size_t>(bucket), 1);
  numbers_.add(kMicroseconds, static_cast<std::uint64_t>(seconds * 1e6));
}

std::uint64_t DurationHistogram::count_up_to(std::size_t i) const {
  std::uint64_t count = 0;
  for (std::size_t bucket = 0; bucket <= i; ++bucket) {
    count += numbers_.get(bucket);
  }
  return count;
}

}  // namespace pmesh
