// A mesh as a Surface in its own units.
#pragma once

#include "core/measure/surface.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

inline Surface unit_surface(const IndexedMesh& mesh) {
  return Surface({mesh.positions, mesh.triangles}, UnitFrame{}, 1);
}

}  // namespace pmesh
