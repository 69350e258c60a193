// A mesh as a Draco file (.drc), or as what a GLB with KHR_draco_mesh_compression holds.
#pragma once

#include <cstdint>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

struct DracoExport {
  Bytes bytes;
  std::uint32_t vertices = 0;  ///< That a decoder gives: more than the mesh's if it is no manifold.
  std::uint32_t faces = 0;
};

enum class DracoNumbers : std::uint8_t {
  floats,            ///< Positions come out as single precision, whatever the lattice.
  doubles_if_needed  ///< As doubles, not compressed, if !fits_single_precision(lattice).
};

/// The attribute of positions, the only one.
inline constexpr std::uint32_t kDracoPositionId = 0;

/// Codes `mesh` with its positions on `lattice`. A decoder's positions, computed in floats, lie
/// within 1/100 of a step of the lattice's points; where floats cannot do that, within two
/// roundings of a float of the largest coordinate. Faces keep their orientation; Draco changes the
/// order of faces, corners and vertices. Fails (runtime) if Draco does or if the lattice spans more
/// than floats do, (out_of_resources) for want of memory. Precondition: `mesh` has a face. Threads:
/// a pure function.
Result<DracoExport> export_draco(const LatticeMesh& mesh, const Lattice& lattice,
                                 DracoNumbers numbers);

}  // namespace pmesh
