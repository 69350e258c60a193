// The PM files under one directory, found by id and hash, kept up to date with the directory.
//
// A file counts if its path gives a mesh id (protocol/mesh_id.h), none of the directories on the
// path is a symbolic link, it is regular (or a link to a regular file under the directory), and is
// a complete PM file. Others are left out, with a line in the log once for each state of the file.
//
// A file is opened by its header and index alone: that its base and chunks are what the index
// promises is the writer's word (`pmesh verify` checks it). A file that was written to in place
// while it was served gives that word no more: its base and chunks are read and checked too, by one
// thread; whoever asks meanwhile is told to come again.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "server/store/mesh_file.h"

namespace pmesh {

/// Threads: all members may be called at the same time. File system calls (now and then a stat for
/// a mesh that is known) happen on the calling thread.
class MeshStore {
 public:
  static constexpr std::chrono::milliseconds kRescanInterval{1000};
  static constexpr std::chrono::milliseconds kLookInterval{20};

  /// Opens every PM file under `directory`, up to half the descriptors that the process may have
  /// (RLIMIT_NOFILE): the others are for connections. Fails (usage) if it is no directory.
  static Result<std::unique_ptr<MeshStore>> open(
      const std::string& directory, std::chrono::milliseconds rescan_interval = kRescanInterval,
      std::chrono::milliseconds look_interval = kLookInterval);

  /// The mesh that stands under this id in the directory now, or stood there a look interval ago;
  /// null if none does. Fails (runtime, out_of_resources) if a file stands there that cannot be
  /// opened now or is being checked: a later try may succeed. Until one does, all fail.
  Result<MeshPtr> find(const std::string& id);

  /// The same with this hash: the mesh that stands there now, or one replaced since that a
  /// transfer still holds.
  Result<MeshPtr> find(const std::string& id, const ContentHash& hash);

  /// All meshes by id. New and removed files show up after at most the rescan interval.
  std::vector<MeshPtr> list();

  /// A number that grows whenever what list() gives changes. What list() gives after this call is
  /// not older than the number.
  std::uint64_t generation();

 private:
  /// What is known of the file of an id.
  struct Entry {
    FileStamp stamp;        // of the file when it was last judged; none if it never was
    MeshPtr mesh;           // null if the file, as stamped, is not one to serve, or not judged now
    FileStamp attempted;    // of the file if it could not be judged, which is in the log
    bool checking = false;  // a thread is reading all of it

    bool is_judged() const { return !checking && attempted == FileStamp{}; }
    bool was_written_to(const FileStamp& now) const;
  };

  MeshStore(std::string root, std::chrono::milliseconds rescan_interval,
            std::chrono::milliseconds look_interval);

  std::string path_of(const std::string& id) const;
  std::optional<Entry> entry_of(const std::string& id) const;
  MeshPtr known_mesh(const std::string& id) const;
  bool has_room(const Entry& before);
  void forget_missing();
  Result<MeshPtr> load(const std::string& id) const;
  Result<MeshPtr> refresh(const std::string& id, const FileStamp& stamp);
  bool begin_check(const std::string& id, const Entry& before);
  void put(const std::string& id, Entry entry, bool is_checker);
  void set_mesh(Entry& entry, MeshPtr mesh);
  void forget(const std::string& id);
  void retire(const MeshPtr& mesh);
  void rescan();
  std::vector<std::string> scan();

  const std::string root_;  // canonical
  const std::chrono::milliseconds rescan_interval_;
  const std::chrono::milliseconds look_interval_;
  const std::size_t most_meshes_;

  mutable std::shared_mutex mutex_;  // guards the three below
  std::map<std::string, Entry> entries_;
  std::size_t mesh_count_ = 0;  // of entries with a mesh
  std::vector<std::weak_ptr<const MeshFile>> retired_;
  std::atomic<std::uint64_t> generation_ = 0;  // changed under the mutex, along with a mesh

  std::atomic<bool> said_full_ = false;
  Look full_look_;

  std::mutex rescan_mutex_;  // held while scanning; guards the two below
  std::chrono::steady_clock::time_point next_rescan_{};
  std::map<std::string, std::string> left_out_;  // paths that the last scan passed over, and why
};

}  // namespace pmesh
