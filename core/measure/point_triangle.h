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

/// The squared distance of `p` to the triangle a, b, c. Never below the true one but for rounding
/// (about 1e-16 of the coordinates); a triangle so thin that its normal is noise counts as its
/// three edges, which is off by at most 1e-8 of its longest.
inline double squared_distance_to_triangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  constexpr double kThinnest = 1e-16;  // squared sine of the angle at a
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const Vec3d normal = cross(ab, ac);
  const double squared_area = dot(normal, normal);
  if (squared_area > kThinnest * dot(ab, ab) * dot(ac, ac)) {
    const double to_c = dot(cross(ab, ap), normal);  // barycentric, times squared_area
    const double to_b = dot(cross(ap, ac), normal);
    if (to_b >= 0 && to_c >= 0 && to_b + to_c <= squared_area) {
      const Vec3d off = ap - (to_b / squared_area) * ab - (to_c / squared_area) * ac;
      return dot(off, off);
    }
  }
  return std::min({squared_distance_to_segment(p, a, ab), squared_distance_to_segment(p, a, ac),
                   squared_distance_to_segment(p, b, c - b)});
}

}  // namespace pmesh
