// Triangle meshes as positions and corner indices: what importers give and exporters take.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace pmesh {

/// Three vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// A mesh as it was read: positions in the file's units and precision, any topology.
struct IndexedMesh {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

/// A mesh whose positions are integers of a Lattice (core/mesh/lattice.h).
struct LatticeMesh {
  std::vector<Vec3i> positions;
  std::vector<Triangle> triangles;
};

}  // namespace pmesh
