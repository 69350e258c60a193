// Axis-aligned bounding boxes.
#pragma once

#include <algorithm>
#include <cassert>
#include <span>

#include "core/base/vec3.h"

namespace pmesh {

template <class T>
struct Box {
  Vec3<T> low, high;

  T longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
  friend bool operator==(const Box&, const Box&) = default;
};

/// Precondition: `points` is not empty.
template <class T>
Box<T> bounding_box(std::span<const Vec3<T>> points) {
  assert(!points.empty());
  Box<T> box{points.front(), points.front()};
  for (const Vec3<T>& p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

}  // namespace pmesh
