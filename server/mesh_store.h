// The PM files under one directory, found by id and hash, kept up to date with the directory.
//
// A file counts if its path gives a mesh id (protocol/mesh_id.h), it is regular, does not lie
// outside the directory by way of a symbolic link, and is a complete PM file. Others are left out,
// with a line in the log once for each state of the file.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "server/mesh_file.h"

namespace pmesh {

/// Threads: all members may be called at the same time. File system calls (a stat for a mesh that
/// is known) happen on the calling thread.
class MeshStore {
 public:
  static constexpr std::chrono::milliseconds kRescanInterval{1000};

  /// Opens every PM file under `directory`. Fails (usage) if it is no directory.
  static Result<std::unique_ptr<MeshStore>> open(
      const std::string& directory, std::chrono::milliseconds rescan_interval = kRescanInterval);

  /// The mesh that stands under this id in the directory now; null if none does.
  MeshPtr find(const std::string& id);

  /// The same with this hash: the mesh that stands there now, or one replaced since that a
  /// transfer still holds.
  MeshPtr find(const std::string& id, const ContentHash& hash);

  /// All meshes by id. New and removed files show up after at most the rescan interval.
  std::vector<MeshPtr> list();

 private:
  /// A file of the directory; the mesh is null if the file, as stamped, is not one to serve.
  struct Entry {
    FileStamp stamp;
    MeshPtr mesh;
  };

  MeshStore(std::string root, std::chrono::milliseconds rescan_interval);

  std::string path_of(const std::string& id) const;
  bool is_inside_root(const std::string& path) const;
  Result<MeshPtr> load(const std::string& id) const;
  MeshPtr refresh(const std::string& id, const FileStamp& stamp);
  void forget(const std::string& id);
  void retire(const MeshPtr& mesh);
  void rescan();
  std::vector<std::string> ids_on_disk() const;

  const std::string root_;  // canonical
  const std::chrono::milliseconds rescan_interval_;

  mutable std::shared_mutex mutex_;  // guards the two below
  std::map<std::string, Entry> entries_;
  std::vector<std::weak_ptr<const MeshFile>> retired_;

  std::mutex rescan_mutex_;  // held while scanning; guards the one below
  std::chrono::steady_clock::time_point next_rescan_{};
};

}  // namespace pmesh
