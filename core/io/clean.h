// From any triangle mesh to an oriented 2-manifold with borders, losing no surface.
#pragma once

#include <cstdint>

#include "core/io/import.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// How often each repair was made. Vertices in minus vertices out is
/// welded + unreferenced - vertices_added; faces in minus faces out is degenerate + duplicate.
struct CleanReport {
  /// Faces dropped because they repeat a vertex, perhaps only once welded.
  std::uint64_t degenerate = 0;
  /// Faces dropped because an earlier one has the same vertices in the same orientation.
  std::uint64_t duplicate = 0;
  /// Vertices merged into another at the same position.
  std::uint64_t welded = 0;
  /// Other vertices dropped because no surviving face uses them.
  std::uint64_t unreferenced = 0;
  /// Faces with the same vertices in opposite orientations, kept as two sheets: each counts once,
  /// however large the sheets.
  std::uint64_t opposite_pairs = 0;
  /// Edges of more than two faces, cut apart. Edges that opposite pairs explain do not count:
  /// those of two pairs, or of a pair and one more face, where each sheet goes on by itself.
  std::uint64_t nonmanifold_edges_cut = 0;
  /// Edges of exactly two faces whose orientations disagree, cut apart.
  std::uint64_t winding_edges_cut = 0;
  /// Vertices cut apart because their faces form more than one fan (bow-ties). Ends of cut edges
  /// and vertices of opposite pairs do not count: they are cut as part of those.
  std::uint64_t nonmanifold_vertices_cut = 0;
  /// Copies of vertices that all these cuts made.
  std::uint64_t vertices_added = 0;
};

struct CleanedMesh {
  /// HalfEdgeMesh::build accepts its triangles. The surviving faces keep their order, orientation
  /// and geometry; zero-area faces with three distinct vertices are kept.
  IndexedMesh mesh;
  CleanReport report;
};

/// Repairs `imported`, in this order: drops degenerate and duplicate faces, welds vertices of
/// exactly the same position (all of a soup's; else only ends of edges with one face, never
/// interior ones), drops faces that this made degenerate or duplicate, cuts non-manifold edges,
/// edges of disagreeing orientation and bow-ties by copying vertices (core/io/edge_matching.h has
/// the rules), and drops unused vertices. Cut borders may open at coarse LODs.
///
/// Preconditions: what parse_mesh() promises (indices in range, finite positions), and at most
/// kNoIndex / 3 faces. The result may be empty (no face survives). Deterministic; O(n log n)
/// whatever the valences; about 50 bytes a face beside the mesh (a soup: 75). Threads: no shared
/// state.
CleanedMesh clean(ImportedMesh imported);

}  // namespace pmesh
