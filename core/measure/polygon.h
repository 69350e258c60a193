// Small convex polygons in space, which are cut until each piece is near one face.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "core/base/vec3.h"
#include "core/measure/surface.h"

namespace pmesh {

struct Plane {
  Vec3d point, normal;  ///< Not necessarily of length 1.

  double height(Vec3d p) const { return dot(p - point, normal); }
};

/// Up to kMaxCorners corners of a planar convex polygon, in order.
class ConvexPolygon {
 public:
  static constexpr std::size_t kMaxCorners = 12;

  ConvexPolygon() = default;
  ConvexPolygon(const ConvexPolygon& other) { *this = other; }
  ConvexPolygon& operator=(const ConvexPolygon& other) {  // not the corners that are none
    count_ = other.count_;
    std::copy_n(other.corners_.begin(), count_, corners_.begin());
    return *this;
  }
  explicit ConvexPolygon(const Corners& t) : count_(3), corners_{t.a, t.b, t.c} {}

  std::span<const Vec3d> corners() const { return {corners_.data(), count_}; }
  bool empty() const { return count_ == 0; }
  /// Whether cutting it by a plane leaves no part with too many corners, even if rounding has left
  /// it not quite convex and the plane crosses every edge.
  bool can_be_cut() const { return count_ + count_ / 2 <= kMaxCorners; }

  /// Its longest extent, about: two corners, and the point midway, which is one of the polygon.
  struct Extent {
    Vec3d from, to;
    Vec3d middle() const { return 0.5 * (from + to); }
  };
  Extent extent() const;
  Vec3d center() const;                     ///< The mean of its corners.
  double radius_about(Vec3d center) const;  ///< To the farthest corner.

  struct Range {
    double low, high;
  };
  Range heights(const Plane& plane) const;  ///< Of its corners.

  /// The parts below (height <= 0) and above a plane; either may be empty. Precondition:
  /// can_be_cut().
  struct Parts;
  Parts cut(const Plane& plane) const;
  /// Two parts with fewer corners. Precondition: it has more than three.
  Parts cut_by_diagonal() const;

 private:
  Vec3d farthest_from(Vec3d point) const;
  void add(Vec3d corner) { corners_[count_++] = corner; }

  std::size_t count_ = 0;
  std::array<Vec3d, kMaxCorners> corners_;
};

struct ConvexPolygon::Parts {
  ConvexPolygon below, above;
};

}  // namespace pmesh
