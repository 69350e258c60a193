// The seam for metrics that collapse triangles to their centroid, and the geometry they read.
//
// A triangle and its three neighbours, the big triangle; 0, 1, 2 are its corners, 3, 4, 5 its
// apexes:
//
//            5 ------ 1 ------ 3        The collapse merges the three corners in their centroid.
//             \      / \      /         The four faces go, every other face of a corner stays. It
//             is
//              \    /   \    /          made of two half-edge collapses with relocation, the first
//               \  /     \  /           of which places the kept vertex: so what is between the two
//                0 ------- 2            is a manifold too, whose faces are as before, as after, or
//                 \       /             next to the second edge (see TriangleStar::Face::moves).
//                  \     /
//                   \   /
//                    4
//
// Lengths are in units of the mesh's bounding-box diagonal, positions relative to the centroid.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/metric.h"

namespace pmesh {

struct TriangleStar {
  /// A triangle with a corner of more faces is not collapsed until the corner has lost some.
  static constexpr std::uint32_t kMaxFaces = OneRing::kMaxFaces;

  /// A face at a corner of the triangle. A neighbour of the triangle has two such corners, and is
  /// here twice.
  struct Face {
    Vec3d corner, second, third;  ///< ccw.
    bool moves = false;  ///< Whether the face is still there once `corner` is in the centroid.
  };

  std::array<VertexId, 3> corners;  ///< ccw.
  Vec3d centroid;                   ///< In the mesh's own frame.
  std::array<Vec3d, 3> positions;   ///< Of the corners.
  std::array<Vec3d, 3> apexes;      ///< Of the neighbour across from each corner.

  // What follows is filled by gather_star() only (see triangle_star.h).
  std::array<std::vector<VertexId>, 3> rings;  ///< Neighbours of each corner, ccw.
  /// Corners in the order of their valences: the first is collapsed into the last, then the second.
  std::array<std::uint32_t, 3> order{};
  std::vector<Face> faces;  ///< Of all corners but for the triangle itself.
};

/// A metric that collapses triangles. Copyable; const members are called from several threads at
/// the same time. Neither cost() nor is_planar() reads what gather_star() fills.
///
/// Its tests are applied in rounds: a round ends when no triangle passes any more.
template <class M>
concept TriangleMetric = requires(const M& metric, const TriangleStar& star, std::uint32_t round) {
  { M::kRounds } -> std::convertible_to<std::uint32_t>;
  /// The first so many rounds have the planar test. (See DecimationReport for the others.)
  { M::kPlanarRounds } -> std::convertible_to<std::uint32_t>;
  /// The cost, at least 0 and finite.
  { metric.cost(star) } -> std::same_as<double>;
  { metric.is_planar(star) } -> std::same_as<bool>;
  /// Of the angle by which a surviving face may turn in that round. 0 for the last: the engine
  /// refuses fold-overs and broken links itself.
  { metric.least_cosine(round) } -> std::same_as<double>;
};

}  // namespace pmesh
