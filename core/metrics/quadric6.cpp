#include "core/metrics/quadric6.h"

#include <initializer_list>

namespace pmesh {

Quadric6 Quadric6::plane(Point6 point, Point6 u, Point6 v) {
  const auto subtract = [](Vec3d a, Vec3d b, Quadric& q) {
    q.xx -= a.x * b.x, q.xy -= a.x * b.y, q.xz -= a.x * b.z;
    q.yy -= a.y * b.y, q.yz -= a.y * b.z, q.zz -= a.z * b.z;
  };
  Quadric6 q;
  q.positions.xx = q.positions.yy = q.positions.zz = 1;
  q.normals = q.positions;
  for (const Point6& e : {u, v}) {
    subtract(e.p, e.p, q.positions);
    subtract(e.m, e.m, q.normals);
    q.mixed_x += -e.p.x * e.m, q.mixed_y += -e.p.y * e.m, q.mixed_z += -e.p.z * e.m;
  }
  // K point: what of the point is upright on the plane.
  const Point6 upright = point - dot(point, u) * u - dot(point, v) * v;
  q.positions.b = -1.0 * upright.p;
  q.normals.b = -1.0 * upright.m;
  q.positions.c = dot(upright, upright);
  return q;
}

}  // namespace pmesh
