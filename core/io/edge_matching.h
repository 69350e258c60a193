// Decides which faces hang together at which edge: a step of clean().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

struct EdgeMatching {
  std::vector<HalfEdgeId> twins;  ///< By half-edge; invalid: the face ends here.
  std::vector<bool> touched;      ///< By vertex: an end of a cut edge, or in a pair.
  std::uint64_t opposite_pairs = 0;
  std::uint64_t nonmanifold_edges_cut = 0;
  std::uint64_t winding_edges_cut = 0;
};

/// Two half-edges of an edge fit if they run in opposite directions and their faces are not each
/// other's opposite copies. They are matched if no half-edge of that edge fits more than one:
///  - two faces that agree in orientation match;
///  - two opposite pairs match sheet by sheet;
///  - an opposite pair and one more face: that one matches the copy whose orientation it has;
///  - an opposite pair alone stays open, as two borders.
/// Otherwise the whole edge is cut: as a winding edge if it has two faces, which then disagree in
/// orientation, as a non-manifold edge if it has more.
/// Preconditions: indices below `vertex_count`, no repeated face (core/io/repeats.h), at most
/// kNoIndex / 3 faces. O(n log n).
EdgeMatching match_edges(std::span<const Triangle> triangles, std::uint32_t vertex_count);

}  // namespace pmesh
