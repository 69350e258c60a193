// Quadric error functions in three dimensions: q(p) = p A p + 2 b p + c with A symmetric, the
// weighted sum of squared distances to planes (M. Garland and P. S. Heckbert, "Surface
// simplification using quadric error metrics", SIGGRAPH 1997, section 5).
#pragma once

#include "core/base/vec3.h"

namespace pmesh {

/// A symmetric matrix.
struct Symmetric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  /// weight n n^T
  static Symmetric outer(Vec3d n, double weight) {
    const Vec3d w = weight * n;
    return {w.x * n.x, w.x * n.y, w.x * n.z, w.y * n.y, w.y * n.z, w.z * n.z};
  }

  Symmetric& operator+=(const Symmetric& m) {
    xx += m.xx, xy += m.xy, xz += m.xz, yy += m.yy, yz += m.yz, zz += m.zz;
    return *this;
  }
  friend Symmetric operator+(Symmetric m, const Symmetric& n) { return m += n; }
  friend Symmetric operator*(double s, const Symmetric& m) {
    return {s * m.xx, s * m.xy, s * m.xz, s * m.yy, s * m.yz, s * m.zz};
  }

  Vec3d times(Vec3d p) const {
    return {xx * p.x + xy * p.y + xz * p.z, xy * p.x + yy * p.y + yz * p.z,
            xz * p.x + yz * p.y + zz * p.z};
  }
  double trace() const { return xx + yy + zz; }
};

struct Quadric : Symmetric {  // A
  Vec3d b;
  double c = 0;

  /// weight (n p + d)^2
  static Quadric plane(Vec3d n, double d, double weight) {
    return {Symmetric::outer(n, weight), d * (weight * n), d * d * weight};
  }

  /// The squared area of the triangle of p and a line from `from` to `to`: |p x e1 + e2|^2 / 4 with
  /// e1 = to - from and e2 = to x from (Lindstrom and Turk 1998, section 4.2).
  static Quadric squared_area(Vec3d from, Vec3d to) {
    const Vec3d e1 = to - from, e2 = cross(to, from);
    const double s = 0.25, length2 = dot(e1, e1);
    return {{s * (length2 - e1.x * e1.x), -s * e1.x * e1.y, -s * e1.x * e1.z,
             s * (length2 - e1.y * e1.y), -s * e1.y * e1.z, s * (length2 - e1.z * e1.z)},
            s * cross(e1, e2),
            s * dot(e2, e2)};
  }

  Quadric& operator+=(const Quadric& q) {
    Symmetric::operator+=(q);
    b += q.b;
    c += q.c;
    return *this;
  }
  friend Quadric operator+(Quadric p, const Quadric& q) { return p += q; }

  double operator()(Vec3d p) const { return dot(p, times(p) + 2.0 * b) + c; }
  Quadric scaled(double s) const {
    return {s * static_cast<const Symmetric&>(*this), s * b, s * c};
  }

  /// Where the function is least when a spring of `stiffness` times A's trace pulls to the origin:
  /// the place nearest to the origin if A leaves a direction open. The origin if A is zero.
  Vec3d least(double stiffness) const {
    const double spring = stiffness * trace();
    const double a = xx + spring, d = yy + spring, f = zz + spring;  // Cholesky: L D L^T
    if (!(trace() > 0)) return {};
    const double l21 = xy / a, l31 = xz / a;
    const double d2 = d - l21 * xy;
    const double l32 = (yz - l31 * xy) / d2;
    const double d3 = f - l31 * xz - l32 * (yz - l31 * xy);
    const double y1 = -b.x, y2 = -b.y - l21 * y1, y3 = -b.z - l31 * y1 - l32 * y2;
    const double z = y3 / d3, y = y2 / d2 - l32 * z;
    return {y1 / a - l21 * y - l31 * z, y, z};
  }

  /// The same function of positions relative to `origin`.
  Quadric relative_to(Vec3d origin) const {
    Quadric moved = *this;
    moved.c = (*this)(origin);
    moved.b += times(origin);
    return moved;
  }
};

}  // namespace pmesh
