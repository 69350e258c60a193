#include "core/metrics/blended_qem.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/decimate/lanes.h"

namespace pmesh {

BlendedQem::Prepared BlendedQem::prepare(const OneRing& ring) const {
  Quadric cost = remembered_[ring.centre].relative_to(ring.origin).scaled(memory_);
  Symmetric& planes = cost;
  for (std::uint32_t i = 0; i < ring.faces; ++i) {
    planes += Symmetric::outer({ring.nx[i], ring.ny[i], ring.nz[i]}, ring.area[i]);
  }
  if (ring.border) {
    cost += Quadric::squared_area({}, ring.position(0));
    cost += Quadric::squared_area(ring.position(ring.neighbours - 1), {});
  }
  return {cost};
}

double BlendedQem::cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
                        const MovedFaces& /*moved*/) const {
  return std::max(0.0, prepared.cost(ring.position(head)));
}

namespace {

struct LaneQuadrics {
  RingLanes::Row xx, xy, xz, yy, yz, zz, bx, by, bz, c;
};

// prepare() and cost() in lanes: the same operations in the same order.
PMESH_WIDE_VECTORS
void price_lanes(const RingLanes& rings, const LaneQuadrics& remembered, LaneCosts& costs) {
  Lanes xx = lanes_of(remembered.xx), xy = lanes_of(remembered.xy), xz = lanes_of(remembered.xz),
        yy = lanes_of(remembered.yy), yz = lanes_of(remembered.yz), zz = lanes_of(remembered.zz);
  const Lanes bx = 2.0 * lanes_of(remembered.bx), by = 2.0 * lanes_of(remembered.by),
              bz = 2.0 * lanes_of(remembered.bz), c = lanes_of(remembered.c);
  Lanes ax = lanes_of(rings.x[0]), ay = lanes_of(rings.y[0]), az = lanes_of(rings.z[0]);
  Lanes aa = ax * ax + ay * ay + az * az;
  for (std::uint32_t i = 1; i <= rings.rows; ++i) {
    const Lanes px = lanes_of(rings.x[i]), py = lanes_of(rings.y[i]), pz = lanes_of(rings.z[i]);
    const Lanes cx = ay * pz - az * py, cy = az * px - ax * pz, cz = ax * py - ay * px;
    const Lanes pp = px * px + py * py + pz * pz;
    const Lanes square = cx * cx + cy * cy + cz * cz;
    Lanes doubled_area;
    for (std::size_t l = 0; l < RingLanes::kLanes; ++l) doubled_area[l] = std::sqrt(square[l]);
    const Lanes limit = kZeroAreaRatio * (aa > pp ? aa : pp);
    const Lanes inverse = 1.0 / doubled_area;
    const Lanes to_unit = doubled_area > limit ? inverse : Lanes{};
    const Lanes nx = to_unit * cx, ny = to_unit * cy, nz = to_unit * cz;
    const Lanes area = 0.5 * doubled_area;
    const Lanes wx = area * nx, wy = area * ny, wz = area * nz;
    xx += wx * nx, xy += wx * ny, xz += wx * nz, yy += wy * ny, yz += wy * nz, zz += wz * nz;
    ax = px, ay = py, az = pz, aa = pp;
  }
  for (std::uint32_t i = 0; i < rings.rows; ++i) {
    const Lanes px = lanes_of(rings.x[i]), py = lanes_of(rings.y[i]), pz = lanes_of(rings.z[i]);
    const Lanes tx = xx * px + xy * py + xz * pz, ty = xy * px + yy * py + yz * pz,
                tz = xz * px + yz * py + zz * pz;
    const Lanes cost = (px * (tx + bx) + py * (ty + by) + pz * (tz + bz)) + c;
    lanes_of(costs[i]) = 0.0 < cost ? cost : Lanes{};
  }
}

}  // namespace

void BlendedQem::price(const RingLanes& rings, LaneCosts& costs) const {
  LaneQuadrics q{};
  for (std::uint32_t l = 0; l < rings.used; ++l) {
    const Quadric r = remembered_[rings.centre[l]].relative_to(rings.origin[l]).scaled(memory_);
    q.xx[l] = r.xx, q.xy[l] = r.xy, q.xz[l] = r.xz, q.yy[l] = r.yy, q.yz[l] = r.yz, q.zz[l] = r.zz;
    q.bx[l] = r.b.x, q.by[l] = r.b.y, q.bz[l] = r.b.z, q.c[l] = r.c;
  }
  price_lanes(rings, q, costs);
}

}  // namespace pmesh
