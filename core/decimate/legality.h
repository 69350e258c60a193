// Whether a half-edge collapse keeps the mesh a simplicial 2-manifold with the same topology, and
// whether it turns a face over.
#pragma once

#include "core/decimate/metric.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Tests that are loosened or given up, one after the other, if a target cannot be had otherwise.
enum class Relaxation : std::uint8_t { turn, planarity, fold_over };

/// The border rule: a border vertex may only move along its border.
inline bool may_move_to(const OneRing& ring, std::uint32_t head) {
  return !ring.border || head == 0 || head + 1 == ring.neighbours;
}

/// The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999) for the collapse of ring.centre
/// into neighbour `head`, with a virtual vertex beyond every border: the two have no common
/// neighbours but the apexes of their edge's faces, and the collapse would not leave fewer than a
/// tetrahedron of a closed component, or a triangle of an open one.
/// Reads only what gather_neighbours fills. Precondition: may_move_to(ring, head).
bool link_condition_holds(const HalfEdgeMesh& mesh, const OneRing& ring, std::uint32_t head);

/// Whether a face of `ring` turns by more than 90 degrees, or loses its area, after which nothing
/// would know how it lay. Faces without area to begin with do not count.
inline bool folds_over(const OneRing& ring, const MovedFaces& moved) {
  for (std::uint32_t k = 0; k < moved.count; ++k) {
    if (moved.cosine[k] > 0) continue;
    if (moved.cosine[k] < 0) return true;
    if (ring.has_area(moved.first + k) && !moved.has_area(k)) return true;
  }
  return false;
}

}  // namespace pmesh
