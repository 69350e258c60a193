// The exact distance of a point to a triangle, whatever its shape.
#pragma once

#include <algorithm>

#include "core/base/vec3.h"

namespace pmesh {

/// The squared distance of `p` to the segment from `a` to `a + edge`, which may be a point.
inline double squared_distance_to_segment(Vec3d p, Vec3d a, Vec3d edge) {
  const Vec3d to_p = p - a;
  const double along = dot(to_p, edge);
  const double squared_length = dot(edge, edge);
  if (!(along > 0)) return dot(to_p, to_p);
  const double t = along < squared_length ? along / squared_length : 1.0;
  const Vec3d off = to_p - t * edge;
  return dot(off, off);
}

/// A triangle made ready to take the distances of several points.
///
/// They are never below the true ones but for rounding (about 1e-16 of the coordinates); a triangle
/// so thin that its normal is noise counts as its three edges, which is off by at most 1e-8 of its
/// longest.
class TriangleDistance {
 public:
  TriangleDistance(Vec3d a, Vec3d b, Vec3d c)
      : a_(a), b_(b), ab_(b - a), ac_(c - a), bc_(c - b), normal_(cross(ab_, ac_)) {
    constexpr double kThinnest = 1e-16;  // squared sine of the angle at a
    squared_area_ = dot(normal_, normal_);
    has_normal_ = squared_area_ > kThinnest * dot(ab_, ab_) * dot(ac_, ac_);
  }

  /// Whether it is not too thin to have one.
  bool has_normal() const { return has_normal_; }

  double squared(Vec3d p) const {
    if (has_normal_) {
      const Vec3d ap = p - a_;
      const double to_c = dot(cross(ab_, ap), normal_);  // barycentric, times squared_area_
      const double to_b = dot(cross(ap, ac_), normal_);
      if (to_b >= 0 && to_c >= 0 && to_b + to_c <= squared_area_) {
        const Vec3d off = ap - (to_b / squared_area_) * ab_ - (to_c / squared_area_) * ac_;
        return dot(off, off);
      }
    }
    return std::min({squared_distance_to_segment(p, a_, ab_),
                     squared_distance_to_segment(p, a_, ac_),
                     squared_distance_to_segment(p, b_, bc_)});
  }

 private:
  Vec3d a_, b_, ab_, ac_, bc_, normal_;
  double squared_area_;
  bool has_normal_;
};

inline double squared_distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  return TriangleDistance(a, b, c).squared(p);
}

}  // namespace pmesh
