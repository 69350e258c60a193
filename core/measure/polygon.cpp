#include "core/measure/polygon.h"

#include <algorithm>
#include <cassert>

namespace pmesh {

Vec3d ConvexPolygon::farthest_from(Vec3d point) const {
  Vec3d farthest = point;
  double most = -1;
  for (const Vec3d corner : corners()) {
    const Vec3d off = corner - point;
    if (const double squared = dot(off, off); squared > most) {
      most = squared;
      farthest = corner;
    }
  }
  return farthest;
}

ConvexPolygon::Extent ConvexPolygon::extent() const {
  const Vec3d end = farthest_from(corners_[0]);
  return {farthest_from(end), end};
}

Vec3d ConvexPolygon::center() const {
  Vec3d sum;
  for (const Vec3d corner : corners()) sum += corner;
  return (1.0 / static_cast<double>(count_)) * sum;
}

double ConvexPolygon::radius_about(Vec3d center) const {
  return length(farthest_from(center) - center);
}

ConvexPolygon::Range ConvexPolygon::heights(const Plane& plane) const {
  const double first = plane.height(corners_[0]);
  Range range{first, first};
  for (const Vec3d corner : corners()) {
    const double height = plane.height(corner);
    range = {std::min(range.low, height), std::max(range.high, height)};
  }
  return range;
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
