// The base mesh, or a chunk's new components, as Draco bytes and back. Clients use it too.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/pm/format.h"

namespace pmesh {

struct EncodedBase {
  Bytes bytes;
  /// What decode_base makes of `bytes`: Draco reorders vertices and faces.
  LatticeMesh decoded;
  /// By vertex of the mesh given: its vertex in `decoded`.
  std::vector<std::uint32_t> decoded_vertex;
};

/// Codes `base` without loss: the same lattice positions, triangles and orientation come back.
/// Fails (runtime) if Draco does. Precondition: HalfEdgeMesh::build accepts base.triangles.
Result<EncodedBase> encode_base(const LatticeMesh& base);

/// The BaseDecoder of native programs (core/pm/mesh_section.h). The counts that Draco's own header
/// claims are held against `counts` before Draco is called. Vertices, faces and corners come in
/// Draco's order. Errors: bad_input, out_of_resources.
Result<LatticeMesh> decode_base(ByteView bytes, const MeshCounts& counts);

}  // namespace pmesh
