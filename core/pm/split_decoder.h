// Decodes chunks of vertex splits onto a RefinableMesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/batch_mesh.h"
#include "core/pm/format.h"
#include "core/pm/split_model.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// What a file's chunks have in common: each is decoded with what the earlier ones taught.
class SplitDecoder {
 public:
  /// `mesh` is the file's base.
  explicit SplitDecoder(const RefinableMesh& mesh) : state_(mesh) {}

  /// Applies the `split_count` splits of `chunk`, which has no other bytes, to `mesh`, whose finest
  /// LOD must stand. Fails (bad_input) at the first split that is malformed or impossible, or if
  /// the chunk's bytes are too few or too many; batches before it remain applied, and nothing more
  /// can be decoded.
  Status decode(ByteView chunk, std::uint32_t split_count, const FileHeader& header,
                RefinableMesh& mesh);

 private:
  SplitModel model_;
  BatchMesh state_;
  std::vector<BatchSplit> batch_;
};

}  // namespace pmesh
