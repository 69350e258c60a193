// Replays a whole PM file and checks its claims: all but measured errors, for which the original
// would be needed.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"
#include "core/pm/format.h"

namespace pmesh {

struct VerifiedFile {
  FileIndex index;
  LatticeMesh full;  ///< The mesh at full resolution.
};

/// Checks that the file at `path` is complete; that hash, CRCs and digests hold; that every split
/// is possible and every chunk ends at the counts its row claims; that the full mesh is a
/// 2-manifold and fills the header's bounding box.
/// Errors: verification, beginning with the path and naming the place, e.g.
/// "dragon.pmesh: incomplete: 1234 bytes are missing"; bad_input for what is no PM file; or what
/// reading and memory gave.
Result<VerifiedFile> verify_file(const std::string& path);

}  // namespace pmesh
