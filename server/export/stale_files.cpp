#include "server/export/stale_files.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/files/file_descriptor.h"
#include "protocol/mesh_id.h"
#include "protocol/routes.h"

namespace pmesh {

namespace fs = std::filesystem;

namespace {

/// The entries of a directory, links left out; none if it cannot be read.
std::vector<fs::directory_entry> entries_of(const fs::path& directory) {
  std::vector<fs::directory_entry> entries;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    if (!entry->is_symlink(error)) entries.push_back(*entry);
  }
  return entries;
}

/// Whether an export can have made this entry of the directory of a mesh.
bool is_of_export(const fs::directory_entry& entry) {
  std::error_code error;
  const std::string name = entry.path().filename().string();
  if (entry.is_directory(error)) return parse_hash(name).has_value();
  if (name == "index.json") return true;
  return name.ends_with(kMeshFileSuffix) &&
         parse_hash(name.substr(0, name.size() - kMeshFileSuffix.size())).has_value();
}

/// What the meshes need, relative to the output.
std::set<std::string> needed_names(const std::vector<ExportedMesh>& meshes) {
  std::set<std::string> names;
  for (const ExportedMesh& mesh : meshes) {
    const std::string hash = to_hex(mesh.index.header.content_hash);
    for (const std::string& name : {std::string("index.json"), hash, hash + ".pmesh"}) {
      names.insert(mesh.id + "/" + name);
    }
  }
  return names;
}

bool holds(const std::vector<std::string>& sorted, const std::string& name) {
  return std::binary_search(sorted.begin(), sorted.end(), name);
}

}  // namespace

std::vector<std::string> stale_files(const std::string& output,
                                     const std::vector<ExportedMesh>& meshes,
                                     const std::vector<std::string>& known_ids) {
  const std::set<std::string> needed = needed_names(meshes);
  std::vector<std::string> stale;
  for (const fs::directory_entry& mesh : entries_of(output)) {
    const std::string id = mesh.path().filename().string();
    if (!is_mesh_id(id)) continue;
    const bool is_skipped = holds(known_ids, id) && !needed.contains(id + "/index.json");
    if (is_skipped) continue;
    for (const fs::directory_entry& entry : entries_of(mesh.path())) {
      const std::string name = id + "/" + entry.path().filename().string();
      if (is_of_export(entry) && !needed.contains(name)) stale.push_back(name);
    }
  }
  std::sort(stale.begin(), stale.end());
  return stale;
}

Status delete_files(const std::string& output, const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    const fs::path target = fs::path(output) / path;
    std::error_code error;
    fs::remove_all(target, error);
    if (error) return file_error(target.string(), "remove", error.value());
    fs::remove(target.parent_path(), error);  // fails as long as something is left in it
  }
  return {};
}

}  // namespace pmesh
