// Moves a refinable mesh to the level of detail that a wish names: the one function behind
// `extract` and `fetch`, so that both give the same bytes.
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/pm/format.h"
#include "core/refine/refinable_mesh.h"
#include "protocol/lod_request.h"

namespace pmesh {

struct AppliedWish {
  std::uint32_t faces = 0;
  std::uint32_t vertices = 0;
  /// False if the wish resolves so (Resolution::reached), or if `mesh` knows too little of the file
  /// to tell the LOD wished for (the finest one known stands then).
  bool reached = true;
};

/// Moves `mesh`, decoded from the file of `index` or from a prefix of it, to the LOD of `wish`.
/// Error, byte and chunk wishes give the LOD at the end of their last whole chunk. Fails as
/// resolve() does.
Result<AppliedWish> apply_wish(const LodRequest& wish, const FileIndex& index, RefinableMesh& mesh);

}  // namespace pmesh
