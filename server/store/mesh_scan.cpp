#include "server/store/mesh_scan.h"

#include <filesystem>

#include "protocol/mesh_id.h"

namespace pmesh {

namespace fs = std::filesystem;

namespace {

/// Why a file of the directory is not even looked into; empty if it is, or is of no interest.
/// `path` is relative to the directory.
std::string reason_to_pass_over(const fs::directory_entry& entry, const std::string& path) {
  std::error_code ignored;
  if (entry.is_directory(ignored)) {
    return entry.is_symlink(ignored) ? "a link to a directory" : "";
  }
  if (!path.ends_with(kMeshFileSuffix)) return "";
  if (!mesh_id_of_path(path)) return "its path gives no mesh id";
  return entry.is_regular_file(ignored) ? "" : "not a regular file";
}

}  // namespace

MeshScan scan_meshes(const std::string& root) {
  MeshScan found;
  std::error_code error;
  fs::recursive_directory_iterator entry(root, fs::directory_options::skip_permission_denied,
                                         error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const std::string path = entry->path().lexically_relative(root).generic_string();
    if (std::string why = reason_to_pass_over(*entry, path); !why.empty()) {
      found.left_out.emplace(entry->path().string(), std::move(why));
    } else if (auto id = mesh_id_of_path(path)) {
      found.ids.push_back(std::move(*id));
    }
  }
  if (error) found.fault = error.message();
  return found;
}

Status check_place(const std::string& root, const std::string& path) {
  std::error_code error;
  const fs::path directory = fs::path(path).parent_path();
  if (fs::canonical(directory, error) != directory || error) {
    return bad_input(path + ": a directory on its path is a link");
  }
  const fs::path target = fs::canonical(path, error);
  if (error || !target.string().starts_with(root == "/" ? root : root + "/")) {
    return bad_input(path + ": a link out of the served directory");
  }
  return {};
}

}  // namespace pmesh
