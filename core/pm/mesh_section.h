// The parts of a PM file that are coded by Draco: the base mesh, and the new components that a
// chunk may begin with.
#pragma once

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/pm/format.h"

namespace pmesh {

/// Decodes a Draco mesh of that many vertices and faces, which it checks before it takes memory for
/// them, to lattice positions and triangles. Given by the caller, because the decoder knows no
/// third party: natively decode_base of core/pm/base_codec.h.
using BaseDecoder = Result<LatticeMesh> (*)(ByteView bytes, const MeshCounts& counts);

/// Decodes a mesh and checks that it has these counts and lies on the lattice. Errors: bad_input,
/// verification, or what `decode` gives.
Result<LatticeMesh> decode_mesh(BaseDecoder decode, ByteView bytes, const MeshCounts& counts,
                                const Lattice& lattice);

struct ChunkParts {
  ByteView components;  ///< A Draco mesh, or empty.
  ByteView splits;
};

/// Takes the chunk of `row` apart. Fails (bad_input) if its components overrun it, or have fewer
/// bytes than as many faces can come from.
Result<ChunkParts> chunk_parts(ByteView chunk, const ChunkRow& row);

/// The start of a chunk with new components: what chunk_parts() takes off.
Bytes write_components(ByteView components);

}  // namespace pmesh
