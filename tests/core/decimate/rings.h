// One-rings of small meshes, for tests of what reads them.
#pragma once

#include <algorithm>

#include "core/decimate/one_ring.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

inline HalfEdgeMesh half_edges(const IndexedMesh& mesh) {
  return HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()))
      .value();
}

/// The one-ring of vertex `v`, in the mesh's own units.
inline OneRing ring_of(const IndexedMesh& mesh, std::uint32_t v) {
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  OneRing ring;
  EXPECT_TRUE(gather_neighbours(work.mesh(), VertexId(v), ring));
  gather_positions(work, ring);
  for (OneRing::Row* row : {&ring.x, &ring.y, &ring.z}) {
    for (double& coordinate : *row) coordinate /= work.frame().scale;
  }
  for (Vec3d* beyond : {&ring.beyond_first, &ring.beyond_last}) {
    *beyond = 1 / work.frame().scale * *beyond;
  }
  gather_faces(ring);
  return ring;
}

/// Which neighbour of the ring's centre `v` is.
inline std::uint32_t index_in(const OneRing& ring, std::uint32_t v) {
  const auto end = ring.ids.begin() + ring.neighbours;
  const auto found = std::find(ring.ids.begin(), end, VertexId(v));
  EXPECT_NE(found, end);
  return static_cast<std::uint32_t>(found - ring.ids.begin());
}

inline MovedFaces moved_to(const OneRing& ring, std::uint32_t v) {
  MovedFaces moved;
  move_faces(ring, index_in(ring, v), moved);
  return moved;
}

/// The corner of a cube at vertex 0; 1, 2 and 3 lie on the x, y and z axes. The cube is in the
/// positive octant.
inline IndexedMesh cube_corner() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 3}, {0, 3, 2}, {0, 2, 1}}};
}

/// A flat unit square, vertices 0 to 3 ccw around the centre 4.
inline IndexedMesh square() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

}  // namespace pmesh
