// A mesh as binary glTF 2.0 (.glb): one node, one mesh, one material.
//
// - Coordinates are the mesh's own, in its units and orientation; glTF's metres and its upward y
// are
//   not known of it. If single precision would lose steps of the lattice (fits_single_precision),
//   positions are the lattice's points counted from its middle, and the node scales and translates
//   them to where they belong.
// - There are no normals. A PM file has none, and to average those of the faces would round off
//   every edge; viewers take the faces' own, as glTF demands where there are none.
// - The material is matt and shows both sides, because scans have holes: glTF's default is a metal,
//   black without an environment, of which the back is not drawn.
#pragma once

#include <cstdint>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

enum class GlbGeometry : std::uint8_t {
  accessors,  ///< Float positions and 16- or 32-bit indices, in the mesh's order.
  draco,      ///< KHR_draco_mesh_compression alone, see core/io/draco_export.h.
};

/// Fails (out_of_resources) if a GLB's 4 GiB are too few, and as export_draco(). Precondition:
/// `mesh` has a face. Throws std::bad_alloc for want of memory. Threads: a pure function.
Result<Bytes> format_glb(const LatticeMesh& mesh, const Lattice& lattice, GlbGeometry geometry);

}  // namespace pmesh
