// From a cleaned mesh to its lattice, and the test that two lattice meshes are the same surface.
#pragma once

#include <optional>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

/// How fine a lattice is: at most one of these, or neither for default_lattice_bits().
struct Precision {
  std::optional<int> bits;          ///< kMinLatticeBits to kMaxLatticeBits.
  std::optional<double> tolerance;  ///< As in make_lattice_within(), in the mesh's units.
};

/// The lattice over `reach`, all the positions that it is to hold, as fine as asked for; by
/// default of default_lattice_bits() of `mesh`, or as many bits below that as double precision can
/// tell apart at these coordinates. Precondition: neither is empty.
Result<Lattice> choose_lattice(const IndexedMesh& mesh, const std::vector<Vec3d>& reach,
                               const Precision& precision);

/// The lattice points nearest to `positions`.
std::vector<Vec3i> quantise(const std::vector<Vec3d>& positions, const Lattice& lattice);

/// Whether `a` and `b` have the same triangles: the same positions in the same orientation, each
/// as often. Vertex and face numbering, and where a triangle starts, do not matter.
bool same_triangles(const LatticeMesh& a, const LatticeMesh& b);

}  // namespace pmesh
