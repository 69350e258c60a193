// What earlier exports left in an output directory.
//
// Threads: as the file system.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "server/export/static_export.h"

namespace pmesh {

/// Paths relative to `output`, sorted: the files {id}/index.json and {id}/{hash}.pmesh and the
/// directories {id}/{hash} of ids that are not in `known_ids` (which is sorted), and of hashes
/// other than those of `meshes`. Whatever has another name, or is a link, is not the export's and
/// not stale; ids that are known but not among the meshes are left alone.
std::vector<std::string> stale_files(const std::string& output,
                                     const std::vector<ExportedMesh>& meshes,
                                     const std::vector<std::string>& known_ids);

/// Removes these and the directories that are empty then. Fails on the first that cannot be
/// removed.
Status delete_files(const std::string& output, const std::vector<std::string>& paths);

}  // namespace pmesh
