// Quadric error functions of points (p, m) in six dimensions: a position and a weighted normal.
// (M. Garland and P. S. Heckbert, "Simplifying surfaces with color and texture using quadric error
// metrics", IEEE Visualization 1998, has such functions for any attributes.)
#pragma once

#include "core/base/vec3.h"
#include "core/metrics/quadric.h"

namespace pmesh {

/// A position p and a weighted normal m.
struct Point6 {
  Vec3d p, m;

  friend Point6 operator+(Point6 a, Point6 b) { return {a.p + b.p, a.m + b.m}; }
  friend Point6 operator-(Point6 a, Point6 b) { return {a.p - b.p, a.m - b.m}; }
  friend Point6 operator*(double s, Point6 a) { return {s * a.p, s * a.m}; }
};

inline double dot(Point6 a, Point6 b) { return dot(a.p, b.p) + dot(a.m, b.m); }

/// q(p, m) = p A p + 2 p C m + m N m + 2 (b p + d m) + c
struct Quadric6 {
  Quadric positions;                ///< A, b and c
  Vec3d mixed_x, mixed_y, mixed_z;  ///< The rows of C.
  Quadric normals;                  ///< N and d; its c stays 0.

  /// The squared distance to the plane through `point` that the orthonormal u and v span (equations
  /// 5 to 7 of the feature-sensitive paper).
  static Quadric6 plane(Point6 point, Point6 u, Point6 v);

  Quadric6& operator+=(const Quadric6& q) {
    positions += q.positions;
    mixed_x += q.mixed_x, mixed_y += q.mixed_y, mixed_z += q.mixed_z;
    normals += q.normals;
    return *this;
  }
  friend Quadric6 operator+(Quadric6 p, const Quadric6& q) { return p += q; }

  double operator()(Point6 v) const { return at_normal(v.m)(v.p); }

  /// The same function of p alone.
  Quadric at_normal(Vec3d m) const {
    Quadric q = positions;
    q.b += times_mixed(m);
    q.c += normals(m);
    return q;
  }

  /// The same function of positions relative to `origin`.
  Quadric6 relative_to(Vec3d origin) const {
    Quadric6 moved = *this;
    moved.positions = positions.relative_to(origin);
    moved.normals.b += origin.x * mixed_x + origin.y * mixed_y + origin.z * mixed_z;
    return moved;
  }

  /// Half the derivative at `at` in the direction `along`.
  double slope(Point6 at, Point6 along) const {
    return dot(along.p, positions.times(at.p) + positions.b + times_mixed(at.m)) +
           dot(along.m, normals.times(at.m) + normals.b + mixed_times(at.p));
  }

  /// Half the second derivative in the direction `along`.
  double curvature(Point6 along) const {
    return dot(along.p, positions.times(along.p) + 2.0 * times_mixed(along.m)) +
           dot(along.m, normals.times(along.m));
  }

 private:
  Vec3d times_mixed(Vec3d m) const { return {dot(mixed_x, m), dot(mixed_y, m), dot(mixed_z, m)}; }
  Vec3d mixed_times(Vec3d p) const { return p.x * mixed_x + p.y * mixed_y + p.z * mixed_z; }
};

}  // namespace pmesh
