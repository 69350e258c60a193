// One finished level of detail of a PM file, as a mesh file's bytes.
#pragma once

#include <cstdint>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/format.h"
#include "protocol/lod_format.h"
#include "protocol/lod_request.h"
#include "server/store/mesh_file.h"

namespace pmesh {

struct LodFile {
  Bytes bytes;
  std::uint64_t faces = 0;  ///< Exact, whatever the wish resolved to.
  std::uint64_t vertices = 0;
  bool reached = true;  ///< As in AppliedWish.
};

/// As resolve(), but also refuses (usage) what no finished mesh can be or should be: chunks without
/// those before them, and more than `most_faces` faces. Threads: a pure function.
Result<Resolution> resolve_lod(const LodRequest& wish, const FileIndex& index,
                               std::uint64_t most_faces);

/// The wish that all wishes for one LOD share: for the vertices that it has. Only inside a chunk
/// with border splits, where faces do not tell vertices, a wish for faces stays as it is.
/// Precondition: `resolution` is what resolve_lod() makes of `wish`. Threads: a pure function.
LodRequest canonical_wish(const LodRequest& wish, const Resolution& resolution,
                          const FileIndex& index);

/// Decodes what the wish needs of the file and writes it in `format`. Takes as long as it takes,
/// and the memory of the decoded mesh and of the result. Fails as resolve_lod(); (runtime,
/// verification) if the file cannot be read or was changed, its path in the message;
/// (out_of_resources) for want of memory. Threads: may be called at the same time for any meshes.
Result<LodFile> export_lod(const MeshFile& mesh, const LodRequest& wish, LodFormat format,
                           std::uint64_t most_faces);

}  // namespace pmesh
