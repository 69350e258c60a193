#include "core/measure/polygon.h"

#include <cassert>

namespace pmesh {

Vec3d ConvexPolygon::center() const {
  Vec3d sum;
  for (const Vec3d corner : corners()) sum += corner;
  return (1.0 / static_cast<double>(count_)) * sum;
}

std::size_t ConvexPolygon::farthest_corner(Vec3d from) const {
  std::size_t farthest = 0;
  double most = -1;
  for (std::size_t k = 0; k < count_; ++k) {
    const Vec3d off = corners_[k] - from;
    if (const double squared = dot(off, off); squared > most) {
      most = squared;
      farthest = k;
    }
  }
  return farthest;
}

ConvexPolygon::Parts ConvexPolygon::cut(const Plane& plane) const {
  assert(can_be_cut());
  std::array<double, kMaxCorners> heights;
  bool any_below = false, any_above = false;
  for (std::size_t k = 0; k < count_; ++k) {
    heights[k] = plane.height(corners_[k]);
    any_below |= heights[k] < 0;
    any_above |= heights[k] > 0;
  }
  if (!any_above) return {*this, {}};
  if (!any_below) return {{}, *this};
  Parts parts;
  for (std::size_t k = 0; k < count_; ++k) {
    const std::size_t next = k + 1 < count_ ? k + 1 : 0;
    if (heights[k] <= 0) parts.below.add(corners_[k]);
    if (heights[k] >= 0) parts.above.add(corners_[k]);
    if ((heights[k] < 0 && heights[next] > 0) || (heights[k] > 0 && heights[next] < 0)) {
      const double t = heights[k] / (heights[k] - heights[next]);
      const Vec3d crossing = corners_[k] + t * (corners_[next] - corners_[k]);
      parts.below.add(crossing);
      parts.above.add(crossing);
    }
  }
  return parts;
}

ConvexPolygon::Parts ConvexPolygon::cut_by_diagonal() const {
  assert(count_ > 3);
  Parts parts;
  const std::size_t middle = count_ / 2;
  for (std::size_t k = 0; k <= middle; ++k) parts.below.add(corners_[k]);
  for (std::size_t k = middle; k < count_; ++k) parts.above.add(corners_[k]);
  parts.above.add(corners_[0]);
  return parts;
}

}  // namespace pmesh
