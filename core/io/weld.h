// Vertices at exactly the same position become one: a step of clean().
#pragma once

#include <cstdint>

#include "core/mesh/indexed_mesh.h"

namespace pmesh {

enum class WeldScope : std::uint8_t {
  all_vertices,     ///< For a soup, whose triangles share no vertices.
  border_vertices,  ///< Ends of edges that have one face; interior vertices stay as they are.
};

/// Lets the faces use the lowest vertex of each position instead of the others, which remain
/// without a face; returns how many those are. -0 equals 0. Faces may become degenerate.
/// Preconditions: positions are finite, no face repeats a vertex. O(n log n).
std::uint64_t weld_vertices(IndexedMesh& mesh, WeldScope scope);

}  // namespace pmesh
