// Meshes on lattices, for the tests of exporters.
#pragma once

#include <string>

#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {

struct LatticeShape {
  std::string name;
  LatticeMesh mesh;
  Lattice lattice;
};

inline LatticeShape on_lattice(const shapes::Shape& shape, int bits) {
  const Lattice lattice = make_lattice(shape.mesh.positions, bits).value();
  return {shape.name, {quantise(shape.mesh.positions, lattice), shape.mesh.triangles}, lattice};
}

}  // namespace pmesh
