// What orders the candidates of a batch, and which of them it may take. Private to core/decimate.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/decimate/indexed_heap.h"

namespace pmesh {

/// The key of an element that is no candidate.
inline constexpr float kNoKey = std::numeric_limits<float>::infinity();

/// An element's key as a float, rounded up, so that its cost is never above it.
inline float batch_key(double key) {
  const float nearest = static_cast<float>(key);
  return static_cast<double>(nearest) < key ? std::nextafter(nearest, kNoKey) : nearest;
}

/// Where elements meet, the one of the least rank wins.
using BatchRank = std::uint64_t;
inline constexpr BatchRank kNoRank = ~BatchRank{0};

/// By key, in steps of an eighth of a factor of two, then by tie_rank(). (Along a slope of keys
/// that are told apart to the last bit every element would wait for its neighbour, and a batch
/// would take as many rounds as the mesh is wide.)
template <class ElementId>
BatchRank batch_rank(float key, ElementId element) {
  constexpr int kDroppedBits = std::numeric_limits<float>::digits - 1 - 3;
  return BatchRank{std::bit_cast<std::uint32_t>(key) >> kDroppedBits} << 32 | tie_rank(element);
}

/// A mesh is coarse once less than one in so many of its elements are left.
inline constexpr std::uint32_t kCoarse = 5;

/// The greatest key that the next batch may take; below all if there is none. `key_of` gives an
/// element's key, `live` are those still there; `to_go` collapses remain. See
/// docs/decisions/0012 for the figures behind the constants.
template <class ElementId, class KeyOf>
float batch_threshold(KeyOf key_of, std::span<const ElementId> live, bool is_coarse,
                      std::uint64_t to_go) {
  constexpr std::size_t kSample = 1 << 13;  // elements whose quantiles stand for those of all
  constexpr double kFineShare = 0.72, kCoarseShare = 0.5;  // of the candidates
  constexpr double kLowShare = 0.2;  // no key above so many times the one of this quantile:
  constexpr float kFineSpread = 100, kCoarseSpread = 6;  // costs of CAD models range widely
  constexpr double kOpenPerCollapse = 4;  // near the target, so that the last batch stays cheap

  std::vector<float> sample;
  const auto take = [&](std::size_t stride) {
    for (std::size_t i = 0; i < live.size(); i += stride) {
      const float key = key_of(live[i]);
      if (key < kNoKey) sample.push_back(key);
    }
  };
  take(1 + live.size() / kSample);
  if (sample.empty()) take(1);
  if (sample.empty()) return -1;
  auto end = sample.end();  // keys from here on are none of those still asked for
  const auto quantile = [&](double share) {
    const double place = std::min(share, 1.0) * static_cast<double>(sample.size() - 1);
    const auto at = sample.begin() + static_cast<std::ptrdiff_t>(place);
    if (at >= end) return *at;
    std::nth_element(sample.begin(), at, end);
    end = at + 1;
    return *at;
  };
  const double needed =
      kOpenPerCollapse * static_cast<double>(to_go) / static_cast<double>(live.size());
  const double share = is_coarse ? kCoarseShare : kFineShare;
  const float spread = is_coarse ? kCoarseSpread : kFineSpread;
  const float most = quantile(std::min(share, needed));  // before the lower one
  return std::min(most, spread * quantile(kLowShare));
}

}  // namespace pmesh
