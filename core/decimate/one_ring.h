// Gathers the geometry that metrics and the fold-over check read (see metric.h).
#pragma once

#include <vector>

#include "core/decimate/metric.h"
#include "core/decimate/working_mesh.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Fills ring.centre, neighbours, faces, border and ids. False if `v` has more than
/// OneRing::kMaxFaces faces; the walk stops there.
bool gather_neighbours(const HalfEdgeMesh& mesh, VertexId v, OneRing& ring);

/// Whether holds(neighbour) is true of all neighbours of `v`, ccw until one fails.
template <class Holds>
bool all_neighbours(const HalfEdgeMesh& mesh, VertexId v, const Holds& holds) {
  const HalfEdgeId first = mesh.outgoing(v);
  HalfEdgeId last, h = first;
  do {
    if (!holds(mesh.target(h))) return false;
    last = h;
    h = mesh.rotate_ccw(h);
  } while (h.valid() && h != first);
  return h.valid() || holds(mesh.apex(last));
}

/// The half-edge from `v` to its neighbour `to`, or, if there is only the other one, that.
inline HalfEdgeId find_spoke(const HalfEdgeMesh& mesh, VertexId v, VertexId to) {
  HalfEdgeId h = mesh.outgoing(v);
  while (mesh.target(h) != to) {
    const HalfEdgeId incoming = HalfEdgeMesh::prev(h);
    h = mesh.twin(incoming);
    if (!h.valid()) return incoming;
  }
  return h;
}

/// Fills in origin, positions and what lies beyond the border, after gather_neighbours.
void gather_positions(const WorkingMesh& work, OneRing& ring);

/// Fills in the faces' normals and areas, after gather_positions.
void gather_faces(OneRing& ring);

/// The faces that move if the centre is collapsed into neighbour `head`, on a border along a
/// border edge. Precondition: head is the first or last neighbour if ring.border.
void move_faces(const OneRing& ring, std::uint32_t head, MovedFaces& moved);

/// The vertex that the last collapse kept, and all its neighbours.
inline void gather_merged(const WorkingMesh& work, std::vector<VertexId>& ring) {
  const VertexId merged = work.log().collapses.back().kept;
  ring.assign({merged});
  all_neighbours(work.mesh(), merged, [&](VertexId v) {
    ring.push_back(v);
    return true;
  });
}

}  // namespace pmesh
