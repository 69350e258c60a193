// Cuts a mesh apart where it is not an oriented 2-manifold: a step of clean().
#pragma once

#include <cstdint>

#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// How often each cut was made; the fields are CleanReport's.
struct CutReport {
  std::uint64_t opposite_pairs = 0;
  std::uint64_t nonmanifold_edges_cut = 0;
  std::uint64_t winding_edges_cut = 0;
  std::uint64_t nonmanifold_vertices_cut = 0;
  std::uint64_t vertices_added = 0;
};

/// Gives faces that must not hang together (core/io/edge_matching.h) vertices of their own: copies,
/// appended after the others. No face is dropped, moved or turned. Afterwards
/// HalfEdgeMesh::build accepts the triangles, once vertices without a face are dropped.
/// Preconditions: as match_edges(). O(n log n); about 50 bytes a face.
CutReport cut_to_manifold(IndexedMesh& mesh);

}  // namespace pmesh
