// The JSON of the routes /catalog and /{id}.
//
// Threads: pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/pm/format.h"

namespace pmesh {

/// One mesh as it is served.
struct CatalogueEntry {
  std::string id;
  const FileIndex* index = nullptr;  ///< Never null; outlives the entry.
};

/// A list of {id, hash, file_bytes, vertices, faces}, in the order given.
std::string catalogue_json(const std::vector<CatalogueEntry>& entries);

/// {id, hash, file_bytes, vertices, faces, base_faces, quantization, bbox {min, max}, chunks
/// [{offset, bytes, vertices, faces, max_error, rms_error}], url}. The box is in the mesh's units;
/// errors are null if the header says that none were measured.
std::string mesh_info_json(const CatalogueEntry& entry);

/// What a client takes from the answer of /{id}; the rest stands in the PM file itself.
struct MeshInfo {
  std::string id;
  ContentHash hash{};
  std::uint64_t file_bytes = 0;
  std::string url;  ///< Of the file: a path on the same server.
};

/// Fails (bad_input) on what mesh_info_json cannot have written; unknown members are ignored.
Result<MeshInfo> parse_mesh_info(std::string_view json);

}  // namespace pmesh
