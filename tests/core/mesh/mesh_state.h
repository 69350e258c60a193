// What the tests of HalfEdgeMesh share: whole states to compare, and triangles as a set.
#pragma once

#include <algorithm>
#include <vector>

#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Corners and twins: everything that undo_split promises to restore.
struct MeshState {
  std::vector<VertexId> corners;
  std::vector<HalfEdgeId> twins;
  std::uint32_t vertices = 0, faces = 0;

  friend bool operator==(const MeshState&, const MeshState&) = default;
};

inline MeshState state_of(const HalfEdgeMesh& mesh) {
  MeshState state;
  state.corners.assign(mesh.corners().begin(), mesh.corners().end());
  for (std::uint32_t h = 0; h < state.corners.size(); ++h) {
    state.twins.push_back(mesh.twin(HalfEdgeId(h)));
  }
  state.vertices = mesh.live_vertices();
  state.faces = mesh.live_faces();
  return state;
}

/// The same triangles, each rotated to begin with its lowest vertex, in sorted order.
inline std::vector<Triangle> sorted_triangles(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace pmesh
