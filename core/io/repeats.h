// Faces that say what another face, or nothing, says: steps of clean().
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

struct DroppedFaces {
  std::uint64_t degenerate = 0;  ///< They repeated a vertex.
  std::uint64_t duplicate = 0;   ///< They repeated an earlier face in the same orientation.
};

/// Drops degenerate and duplicate faces; the others keep their order. O(n log n).
DroppedFaces drop_repeats(std::vector<Triangle>& triangles);

/// By face: the one with the same vertices in the opposite orientation, or an invalid id.
/// Precondition: drop_repeats() has been called, so there is at most one. O(n log n).
std::vector<FaceId> find_opposites(std::span<const Triangle> triangles);

}  // namespace pmesh
