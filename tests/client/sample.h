// A PM file in memory for the client's tests, and what a local extract of it gives.
#pragma once

#include "core/base/bytes.h"
#include "core/mesh/indexed_mesh.h"
#include "core/pm/format.h"
#include "protocol/lod_request.h"

namespace pmesh::test {

/// `mesh` decimated and encoded.
Bytes make_pm_file(const IndexedMesh& mesh, std::uint32_t base_faces = 60);

/// A bumpy open grid of several chunks (about 50 KB), made once: its base and first chunks lie in
/// the first 16 KiB, the rest does not. Its errors are made up: 8 after the first chunk, and half
/// of that after each further one.
const Bytes& sample_file();
/// Its header and index.
const FileIndex& sample_index();
/// Another file of the same kind, without measured errors.
const Bytes& other_file();

LodRequest wish(const char* query);

/// The PLY file of `wish` out of the whole file `pm`, decoded in one piece.
Bytes extracted(const Bytes& pm, const LodRequest& wish);

}  // namespace pmesh::test
