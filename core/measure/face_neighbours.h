// Which faces share an edge.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// By face: the face beyond its edges ab, bc and ca, or kNoIndex beyond a border. Of an edge with
/// more than two faces, each has one of the others. Precondition: indices are below vertex_count.
/// O(n).
std::vector<std::array<std::uint32_t, 3>> face_neighbours(std::span<const Triangle> triangles,
                                                          std::uint32_t vertex_count);

}  // namespace pmesh
