#include "core/metrics/memoryless_lanes.h"

#include <cstring>

#include "core/decimate/wide_vectors.h"

namespace pmesh::memoryless_lanes {

constexpr std::size_t kLanes = PlacedRing::kBlock;

// A sum for each lane and then their total: compilers do not change the order of additions.
PMESH_WIDE_VECTORS
void sum_faces(const PlacedRing& ring, FaceSums& sums) {
  using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;
  Lanes xx{}, xy{}, xz{}, yy{}, yz{}, zz{}, nx{}, ny{}, nz{}, sx{}, sy{}, sz{};
  for (std::size_t i = 0; i < ring.faces; i += kLanes) {
    Lanes ax, ay, az, bx, by, bz;
    std::memcpy(&ax, &ring.x[i], sizeof ax);
    std::memcpy(&ay, &ring.y[i], sizeof ay);
    std::memcpy(&az, &ring.z[i], sizeof az);
    std::memcpy(&bx, &ring.x[i + 1], sizeof bx);
    std::memcpy(&by, &ring.y[i + 1], sizeof by);
    std::memcpy(&bz, &ring.z[i + 1], sizeof bz);
    const Lanes cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
    xx += cx * cx, xy += cx * cy, xz += cx * cz, yy += cy * cy, yz += cy * cz, zz += cz * cz;
    nx += cx, ny += cy, nz += cz;
    sx += bx, sy += by, sz += bz;
  }
  const auto total = [](const Lanes& lanes) {
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
  };
  sums.areas = {total(xx), total(xy), total(xz), total(yy), total(yz), total(zz)};
  sums.normal = {total(nx), total(ny), total(nz)};
  sums.seconds = {total(sx), total(sy), total(sz)};
}

// In the plane of volume preservation the least cost fixes p by two more planes, across u and v
// (section 3 of the paper).
PMESH_WIDE_VECTORS
void place(const Edges& __restrict edges, std::size_t count, Places& __restrict places) {
  const std::size_t whole_blocks = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = 0; i < whole_blocks; ++i) {
    const auto [cost, normal, distance] =
        star_volumes(edges.half[i], edges.left[i], edges.right[i], edges.areas_a[i],
                     edges.normal_a[i], edges.areas_b[i], edges.normal_b[i]);
    const Vec3d first = cross(normal, least_axis(normal)), second = cross(normal, first);
    const Vec3d u = cost.times(first), v = cost.times(second);
    const Vec3d normal_u = cross(normal, u), u_v = cross(u, v), v_normal = cross(v, normal);
    const double along = dot(u, normal), volume = dot(v, normal_u);
    const bool is_u_independent = along * along < (1 - kSine2) * dot(u, u) * dot(normal, normal);
    const bool is_v_independent = volume * volume > kSine2 * dot(v, v) * dot(normal_u, normal_u);
    const Vec3d p =
        1 / volume *
        (distance * u_v - dot(first, cost.b) * v_normal - dot(second, cost.b) * normal_u);
    const double cost_there = kVolumeFactor * cost(p);
    places.cost[i] = cost_there > 0 ? cost_there : 0;
    places.position.set(i, p);
    places.is_settled[i] = (is_u_independent & is_v_independent) ? 1 : 0;
  }
}

}  // namespace pmesh::memoryless_lanes
