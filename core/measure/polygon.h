// Small convex polygons in space, which are cut until each piece is near one face.
#pragma once

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
  static constexpr std::size_t kMaxCorners = 10;

  ConvexPolygon() = default;
  explicit ConvexPolygon(const Corners& t) : count_(3), corners_{t.a, t.b, t.c} {}

  std::span<const Vec3d> corners() const { return {corners_.data(), count_}; }
  bool empty() const { return count_ == 0; }
  /// Whether cutting it by a plane leaves parts that are not too many-cornered.
  bool can_be_cut() const { return count_ < kMaxCorners; }

  Vec3d center() const;  ///< The mean of its corners: a point of the polygon.
  std::size_t farthest_corner(Vec3d from) const;

  /// The parts below (height <= 0) and above a plane; either may be empty. Precondition:
  /// can_be_cut().
  struct Parts;
  Parts cut(const Plane& plane) const;
  /// Two parts with fewer corners. Precondition: it has more than three.
  Parts cut_by_diagonal() const;

 private:
  void add(Vec3d corner) { corners_[count_++] = corner; }

  std::size_t count_ = 0;
  std::array<Vec3d, kMaxCorners> corners_;
};

struct ConvexPolygon::Parts {
  ConvexPolygon below, above;
};

}  // namespace pmesh
