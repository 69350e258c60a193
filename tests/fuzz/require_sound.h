// What must hold of whatever a decoder accepted; the fuzz targets stop where it does not.
#pragma once

#include <cstdlib>

#include "core/refine/refinable_mesh.h"

namespace pmesh {

inline void require(bool condition) {
  if (!condition) std::abort();
}

inline void require_same(const LatticeMesh& a, const LatticeMesh& b) {
  require(a.triangles == b.triangles && a.positions == b.positions);
}

/// A valid mesh on the lattice, which is the same after it was coarsened to its base and refined.
inline void require_sound(RefinableMesh& mesh, int lattice_bits) {
  require(mesh.connectivity().validate().ok());
  for (const Vec3i p : mesh.positions()) require((p.x | p.y | p.z) >> lattice_bits == 0);
  const LatticeMesh finest = mesh.snapshot();
  mesh.set_steps(0);
  mesh.set_finest();
  require_same(mesh.snapshot(), finest);
}

}  // namespace pmesh
