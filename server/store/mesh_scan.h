// Which files of a directory are meshes by their place and name.
//
// Threads: pure functions, but for looking at the file system.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace pmesh {

struct MeshScan {
  std::vector<std::string> ids;                 ///< Of the files that may be meshes, in any order.
  std::map<std::string, std::string> left_out;  ///< Paths that were passed over, and why.
  std::string fault;  ///< Why the walk ended before all was seen; empty if it did not.
};

/// Walks over all below `root`, a canonical path, without following links to directories.
MeshScan scan_meshes(const std::string& root);

/// Fails (bad_input) if a directory on the way from `root` to the file at `path` is a link, as no
/// directory may have two ids, or if the file is a link out of `root`.
Status check_place(const std::string& root, const std::string& path);

}  // namespace pmesh
