#include "server/store/mesh_store.h"

#include <algorithm>
#include <filesystem>

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include "core/files/out_of_memory.h"
#include "protocol/mesh_id.h"
#include "server/store/mesh_scan.h"

namespace pmesh {

namespace fs = std::filesystem;

namespace {

std::size_t half_of_descriptors() {
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return 512;
  return static_cast<std::size_t>(limit.rlim_cur / 2);
}

/// Whether a later try may end otherwise, though the file stays as it is.
bool may_pass(const Error& error) {
  return error.code == ErrorCode::runtime || error.code == ErrorCode::out_of_resources;
}

/// Whether the file was written to, not replaced by another.
bool changed_in_place(const FileStamp& before, const FileStamp& now) {
  return before.device == now.device && before.inode == now.inode && before != now;
}

/// `mesh`, opened from `path`, if its base and chunks are what its index promises.
Result<MeshPtr> checked(const MeshPtr& mesh, const std::string& path) {
  return catching_out_of_memory([&]() -> Result<MeshPtr> {
    if (Status sections = mesh->check_sections(); !sections) return sections.error();
    if (!mesh->intact()) return runtime_error(path + ": changed while it was checked");
    return mesh;
  });
}

}  // namespace

/// Whether the file that has the stamp `now` is one that was known, with other bytes.
bool MeshStore::Entry::was_written_to(const FileStamp& now) const {
  return changed_in_place(stamp, now) || changed_in_place(attempted, now);
}

Result<std::unique_ptr<MeshStore>> MeshStore::open(const std::string& directory,
                                                   std::chrono::milliseconds rescan_interval,
                                                   std::chrono::milliseconds look_interval) {
  std::error_code error;
  const fs::path root = fs::canonical(directory, error);
  if (error || !fs::is_directory(root, error)) {
    return Error{ErrorCode::usage, directory + ": not a directory that can be read"};
  }
  std::unique_ptr<MeshStore> store(new MeshStore(root.string(), rescan_interval, look_interval));
  store->rescan();
  return store;
}

MeshStore::MeshStore(std::string root, std::chrono::milliseconds rescan_interval,
                     std::chrono::milliseconds look_interval)
    : root_(std::move(root)),
      rescan_interval_(rescan_interval),
      look_interval_(look_interval),
      most_meshes_(half_of_descriptors()) {}

/// The mesh of this id if its name was looked at just now; else null.
MeshPtr MeshStore::known_mesh(const std::string& id) const {
  const std::shared_lock lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end() || !entry->second.mesh) return nullptr;
  return entry->second.mesh->name_look().is_due(look_interval_) ? nullptr : entry->second.mesh;
}

Result<MeshPtr> MeshStore::find(const std::string& id) {
  if (MeshPtr known = known_mesh(id)) return known;
  if (!is_mesh_id(id)) return MeshPtr();
  const auto stamp = stamp_of(path_of(id));
  if (!stamp) {
    forget(id);
    return MeshPtr();
  }
  {
    const std::shared_lock lock(mutex_);
    const auto entry = entries_.find(id);
    const bool is_known = entry != entries_.end() && entry->second.is_judged();
    if (is_known && entry->second.stamp == *stamp) return entry->second.mesh;
  }
  return refresh(id, *stamp);
}

Result<MeshPtr> MeshStore::find(const std::string& id, const ContentHash& hash) {
  const Result<MeshPtr> current = find(id);
  if (current && *current && (*current)->hash() == hash) return current;
  const std::shared_lock lock(mutex_);
  for (const auto& retired : retired_) {
    MeshPtr mesh = retired.lock();
    if (mesh && mesh->id() == id && mesh->hash() == hash && mesh->intact()) return mesh;
  }
  if (!current) return current.error();
  return MeshPtr();
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

std::uint64_t MeshStore::generation() {
  rescan();
  return generation_;
}

std::string MeshStore::path_of(const std::string& id) const {
  return root_ + "/" + path_of_mesh_id(id);
}

std::optional<MeshStore::Entry> MeshStore::entry_of(const std::string& id) const {
  const std::shared_lock lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return {};
  return entry->second;
}

/// Whether one more mesh may be open, or the file of `before` only takes its own place.
bool MeshStore::has_room(const Entry& before) {
  if (before.mesh) return true;
  forget_missing();
  const std::shared_lock lock(mutex_);
  if (mesh_count_ < most_meshes_) return true;
  if (!said_full_.exchange(true)) {
    spdlog::warn("{}: of its PM files {} are served, which takes half the descriptors; no more fit",
                 root_, mesh_count_);
  }
  return false;
}

/// If there is no room, lets go of meshes whose files are gone; once in a rescan interval.
void MeshStore::forget_missing() {
  std::vector<std::string> ids;
  {
    const std::shared_lock lock(mutex_);
    if (mesh_count_ < most_meshes_ || !full_look_.is_due(rescan_interval_)) return;
    for (const auto& [id, entry] : entries_) ids.push_back(id);
  }
  for (const std::string& id : ids) {
    if (!stamp_of(path_of(id))) forget(id);
  }
}

Result<MeshPtr> MeshStore::load(const std::string& id) const {
  const std::string path = path_of(id);
  if (Status place = check_place(root_, path); !place) return place.error();
  return MeshFile::open(id, path);
}

/// Opens the file of `id`, which had `stamp`, and makes it the one that is found. A file that is
/// not one to serve is remembered, so as not to be opened and logged again; one that could not be
/// judged for a reason that may pass is tried again, and logged once.
Result<MeshPtr> MeshStore::refresh(const std::string& id, const FileStamp& stamp) {
  const Entry before = entry_of(id).value_or(Entry{});
  const Error being_checked = runtime_error(path_of(id) + ": is being checked");
  if (before.checking) return being_checked;
  if (!has_room(before)) {
    return Error{ErrorCode::out_of_resources, path_of(id) + ": too many meshes are open"};
  }
  Result<MeshPtr> loaded = load(id);
  const bool needs_check = loaded && before.was_written_to((*loaded)->stamp());
  if (needs_check && !begin_check(id, before)) return being_checked;
  if (needs_check) loaded = checked(*loaded, path_of(id));
  const bool is_open_question = !loaded && may_pass(loaded.error());
  // A file replaced between stat and open has the stamp of its mesh.
  const MeshPtr mesh = loaded ? *loaded : nullptr;
  Entry now{.stamp = mesh ? mesh->stamp() : stamp, .mesh = mesh, .attempted = {}};
  if (is_open_question) now = {.stamp = before.stamp, .mesh = nullptr, .attempted = stamp};
  put(id, std::move(now), needs_check);
  if (!loaded && before.attempted != stamp) spdlog::warn("skipped {}", loaded.error().message);
  if (is_open_question) return loaded.error();
  return mesh;
}

/// Whether the calling thread is the one to check the file of `id`, of which `before` was known:
/// one reads it, not all who ask. It must put() what came of it, as the checker.
bool MeshStore::begin_check(const std::string& id, const Entry& before) {
  const std::unique_lock lock(mutex_);
  const auto found = entries_.find(id);
  if (found == entries_.end()) return false;
  Entry& entry = found->second;
  const bool is_judged_since = entry.stamp != before.stamp || entry.attempted != before.attempted;
  if (entry.checking || is_judged_since) return false;
  set_mesh(entry, nullptr);  // whose bytes were written over
  entry.checking = true;
  return true;
}

/// While a file is checked, only the checker has a say.
void MeshStore::put(const std::string& id, Entry entry, bool is_checker) {
  const std::unique_lock lock(mutex_);
  Entry& place = entries_[id];
  if (place.checking && !is_checker) return;
  set_mesh(place, entry.mesh);
  place = std::move(entry);
}

/// Gives an entry another mesh, or none. Needs the mutex.
void MeshStore::set_mesh(Entry& entry, MeshPtr mesh) {
  if (entry.mesh == mesh) return;
  if (mesh) ++mesh_count_;
  if (entry.mesh) --mesh_count_;
  ++generation_;
  std::swap(entry.mesh, mesh);
  retire(mesh);
}

void MeshStore::forget(const std::string& id) {
  {
    const std::shared_lock lock(mutex_);
    if (!entries_.contains(id)) return;
  }
  const std::unique_lock lock(mutex_);
  const auto entry = entries_.find(id);
  if (entry == entries_.end()) return;
  set_mesh(entry->second, nullptr);
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

  std::vector<std::string> ids = scan();
  {  // A scan may end early: what was known and did not turn up is forgotten only if it is gone.
    const std::shared_lock lock(mutex_);
    for (const auto& [id, entry] : entries_) ids.push_back(id);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const std::string& id : ids) (void)find(id);
}

/// The ids of the files below the directory. Logs what it passes over, unless the last scan did.
std::vector<std::string> MeshStore::scan() {
  MeshScan found = scan_meshes(root_);
  for (const auto& [path, why] : found.left_out) {
    if (!left_out_.contains(path)) spdlog::warn("skipped {}: {}", path, why);
  }
  if (!found.fault.empty()) {
    spdlog::warn("scan of {} ended early: {}", root_, found.fault);
    found.left_out.merge(left_out_);
  }
  left_out_ = std::move(found.left_out);
  return std::move(found.ids);
}

}  // namespace pmesh
