// The arithmetic of memoryless.h that nearly every edge needs, on several faces or edges at once:
// structures of arrays, for vector instructions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/base/vec3.h"
#include "core/decimate/edge_metric.h"
#include "core/metrics/quadric.h"

namespace pmesh::memoryless_lanes {

/// The paper's lambda: how volumes and border areas share in the cost.
inline constexpr double kVolumeShare = 0.5;
/// A swept volume is a sixth of a height over a doubled area, times that area: what the squared
/// product of height and doubled area counts in the cost.
inline constexpr double kVolumeFactor = kVolumeShare / 36;
/// Constraints are independent if there is more than a degree between them (the paper's alpha): its
/// squared sine.
inline constexpr double kSine2 = 3.0458648e-4;

struct FaceSums {
  Symmetric areas;
  Vec3d normal;
  Vec3d seconds;  ///< Positions of the faces' second neighbours.
};

/// What the faces of `ring` sum up to: see Memoryless::Summary.
void sum_faces(const PlacedRing& ring, FaceSums& sums);

/// The axis that makes the largest angle with n. Without branches: which one it is cannot be
/// foreseen, and vector instructions have none.
inline Vec3d least_axis(Vec3d n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const double is_x = ((x <= y) & (x <= z)) ? 1 : 0;
  const double is_y = ((is_x == 0) & (y <= z)) ? 1 : 0;
  return {is_x, is_y, 1 - is_x - is_y};
}

/// What the faces around an edge say of the place of its merged vertex, relative to the midpoint.
struct StarVolumes {
  Quadric squares;  ///< Of the swept volumes, over kVolumeFactor.
  Vec3d normal;     ///< Volume preservation (section 4.1): normal . place = distance.
  double distance = 0;
};

/// From the sums over the faces of both ends, a at -half and b at half. The planes of an end's
/// faces all pass through it, those of the edge's two faces through both: they come up in both
/// sums. `right` is zero on a border.
inline StarVolumes star_volumes(Vec3d half, Vec3d left, Vec3d right, const Symmetric& areas_a,
                                Vec3d normal_a, const Symmetric& areas_b, Vec3d normal_b) {
  const Vec3d edge = 2.0 * half;
  const Vec3d normal_left = cross(edge, left), normal_right = cross(right, edge);
  const Vec3d times_a = areas_a.times(half), times_b = areas_b.times(half);
  return {
      {areas_a + areas_b + Symmetric::outer(normal_left, -1) + Symmetric::outer(normal_right, -1),
       times_a - times_b, dot(half, times_a + times_b)},
      normal_a + normal_b - (normal_left + normal_right),
      dot(half, normal_b - normal_a)};
}

/// Of a batch.
inline constexpr std::size_t kBatch = 16;
using Row = std::array<double, kBatch>;

struct VectorRows {
  Row x{}, y{}, z{};

  Vec3d operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vec3d v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

struct MatrixRows {
  Row xx{}, xy{}, xz{}, yy{}, yz{}, zz{};

  Symmetric operator[](std::size_t i) const { return {xx[i], xy[i], xz[i], yy[i], yz[i], zz[i]}; }
  void set(std::size_t i, const Symmetric& m) {
    xx[i] = m.xx, xy[i] = m.xy, xz[i] = m.xz, yy[i] = m.yy, yz[i] = m.yz, zz[i] = m.zz;
  }
};

/// Edges between interior vertices, with the sums over the faces of both ends. Positions are
/// relative to the edge's midpoint.
struct Edges {
  VectorRows half;         ///< The end b.
  VectorRows left, right;  ///< Apexes.
  VectorRows normal_a, normal_b;
  MatrixRows areas_a, areas_b;
};

struct Places {
  Row cost{};
  VectorRows position;
  Row is_settled{};  ///< 0 if volume preservation and the least cost leave a direction open.
};

/// Where volume preservation and the least cost put the merged vertices of the first `count` edges.
void place(const Edges& edges, std::size_t count, Places& places);

}  // namespace pmesh::memoryless_lanes
