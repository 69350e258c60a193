// Decodes one chunk of vertex splits onto a RefinableMesh.
#pragma once

#include <cstdint>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/format.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// Applies the `split_count` splits of `chunk` to `mesh`, whose finest LOD must stand. Fails
/// (bad_input) at the first split that is malformed or impossible, or if the chunk's bytes are too
/// few or too many; splits before it remain applied.
Status decode_chunk(ByteView chunk, std::uint32_t split_count, const FileHeader& header,
                    RefinableMesh& mesh);

}  // namespace pmesh
