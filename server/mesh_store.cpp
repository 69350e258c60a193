#include "server/mesh_store.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <spdlog/spdlog.h>

#include "protocol/mesh_id.h"

namespace pmesh {

namespace fs = std::filesystem;

Result<std::unique_ptr<MeshStore>> MeshStore::open(const std::string& directory,
                                                   std::chrono::milliseconds rescan_interval) {
  std::error_code error;
  const fs::path root = fs::canonical(directory, error);
  if (error || !fs::is_directory(root, error)) {
    return Error{ErrorCode::usage, directory + ": not a directory that can be read"};
  }
  std::unique_ptr<MeshStore> store(new MeshStore(root.string(), rescan_interval));
  store->rescan();
  return store;
}

MeshStore::MeshStore(std::string root, std::chrono::milliseconds rescan_interval)
    : root_(std::move(root)), rescan_interval_(rescan_interval) {}

MeshPtr MeshStore::find(const std::string& id) {
  if (!is_mesh_id(id)) return nullptr;
  const auto stamp = stamp_of(path_of(id));
  if (!stamp) {
    forget(id);
    return nullptr;
  }
  {
    const std::shared_lock lock(mutex_);
    const auto entry = entries_.find(id);
    if (entry != entries_.end() && entry->second.stamp == *stamp) return entry->second.mesh;
  }
  return refresh(id, *stamp);
}

MeshPtr MeshStore::find(const std::string& id, const ContentHash& hash) {
  MeshPtr current = find(id);
  if (current && current->hash() == hash) return current;
  const std::shared_lock lock(mutex_);
  for (const auto& retired : retired_) {
    MeshPtr mesh = retired.lock();
    if (mesh && mesh->id() == id && mesh->hash() == hash) return mesh;
  }
  return nullptr;
}

std::vector<MeshPtr> MeshStore::list() {
  rescan();
  std::vector<MeshPtr> meshes;
  const std::shared_lock lock(mutex_);
  for (const auto& [id, entry] : entries_) {
    if (entry.mesh) meshes.push_back(entry.mesh);
  }
  return meshes;
}

std::string MeshStore::path_of(const std::string& id) const {
  return root_ + "/" + path_of_mesh_id(id);
}

bool MeshStore::is_inside_root(const std::string& path) const {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  return !error && target.string().starts_with(root_ == "/" ? root_ : root_ + "/");
}

Result<MeshPtr> MeshStore::load(const std::string& id) const {
  const std::string path = path_of(id);
  if (!is_inside_root(path)) return bad_input(path + ": a link out of the served directory");
  return MeshFile::open(id, path);
}

/// Opens the file of `id`, which had `stamp`, and makes it the one that is found. A file that is
/// not one to serve is remembered, so as not to be opened and logged again; one that could not be
/// opened for a passing reason is not.
MeshPtr MeshStore::refresh(const std::string& id, const FileStamp& stamp) {
  const Result<MeshPtr> loaded = load(id);
  if (!loaded) {
    spdlog::warn("skipped {}", loaded.error().message);
    const ErrorCode code = loaded.error().code;
    if (code == ErrorCode::runtime || code == ErrorCode::out_of_resources) return nullptr;
  }
  // A file replaced between stat and open has the stamp of its mesh.
  Entry entry = loaded ? Entry{(*loaded)->stamp(), *loaded} : Entry{stamp, nullptr};
  const std::unique_lock lock(mutex_);
  std::swap(entries_[id], entry);
  retire(entry.mesh);
  return loaded ? *loaded : nullptr;
}

void MeshStore::forget(const std::string& id) {
  {
    const std::shared_lock lock(mutex_);
    if (!entries_.contains(id)) return;
  }
  const std::unique_lock lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  retire(entry->second.mesh);
  entries_.erase(entry);
}

/// Keeps `mesh` findable for as long as a transfer holds it. Needs the mutex.
void MeshStore::retire(const MeshPtr& mesh) {
  std::erase_if(retired_, [](const auto& retired) { return retired.expired(); });
  if (mesh) retired_.push_back(mesh);
}

void MeshStore::rescan() {
  const std::unique_lock scanning(rescan_mutex_, std::try_to_lock);
  const auto now = std::chrono::steady_clock::now();
  if (!scanning.owns_lock() || now < next_rescan_) return;
  next_rescan_ = now + rescan_interval_;

  const std::vector<std::string> found = ids_on_disk();
  std::set<std::string> gone;
  {
    const std::shared_lock lock(mutex_);
    for (const auto& [id, entry] : entries_) gone.insert(id);
  }
  for (const std::string& id : found) {
    gone.erase(id);
    find(id);
  }
  for (const std::string& id : gone) forget(id);
}

std::vector<std::string> MeshStore::ids_on_disk() const {
  std::vector<std::string> ids;
  std::error_code error;
  fs::recursive_directory_iterator entry(root_, fs::directory_options::skip_permission_denied,
                                         error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const auto id = mesh_id_of_path(entry->path().lexically_relative(root_).generic_string());
    if (id) ids.push_back(*id);
  }
  if (error) spdlog::warn("scan of {} ended early: {}", root_, error.message());
  return ids;
}

}  // namespace pmesh
