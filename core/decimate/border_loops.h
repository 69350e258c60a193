// The borders of a half-edge mesh as doubly linked loops of vertices. The mesh itself finds the
// next border vertex at once, but the previous one only by walking a fan, however large.
#pragma once

#include <vector>

#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Refers to a mesh, which must outlive it. Arguments are live border vertices.
class BorderLoops {
 public:
  explicit BorderLoops(const HalfEdgeMesh& mesh) : mesh_(mesh) {
    for (std::uint32_t i = 0; i < mesh.vertex_slots(); ++i) {
      const VertexId v(i);
      if (!mesh.is_live(v) || !mesh.is_border(v)) continue;
      if (previous_.empty()) previous_.resize(mesh.vertex_slots());
      previous_[next(v).value] = v;
    }
  }

  /// The neighbour along the border that has the mesh to the left of v -> next(v).
  VertexId next(VertexId v) const { return mesh_.target(mesh_.outgoing(v)); }
  VertexId previous(VertexId v) const { return previous_[v.value]; }

  /// Takes `v` out of its loop. To be called just before the collapse that removes it.
  void remove(VertexId v) { previous_[next(v).value] = previous(v); }

  /// Follows the mesh to compact ids.
  void renumber(const CompactIds& ids) {
    if (previous_.empty()) return;
    close_up(previous_, ids.vertices);
    for (VertexId& v : previous_) {
      if (v.valid()) v = ids.new_vertices[v.value];
    }
  }

 private:
  const HalfEdgeMesh& mesh_;
  std::vector<VertexId> previous_;  // by vertex; empty if the mesh has no border
};

}  // namespace pmesh
