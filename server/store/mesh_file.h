// One PM file as it is served: immutable from the moment it was opened.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <sys/stat.h>

#include "core/base/result.h"
#include "core/pm/pm_file.h"
#include "server/store/look.h"

namespace pmesh {

/// What tells one state of a file from another without reading it.
struct FileStamp {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::int64_t bytes = 0;
  std::int64_t modified_ns = 0;

  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// The stamp of the regular file at `path`; nothing if there is none.
std::optional<FileStamp> stamp_of(const std::string& path);

/// Threads: all members may be called at the same time.
class MeshFile {
 public:
  /// Opens the file, reads its prologue (no bodies) and checks it, the content hash and the size
  /// included. Errors name the path; a partial file is one of them.
  static Result<std::shared_ptr<const MeshFile>> open(std::string id, const std::string& path);

  MeshFile(std::string id, PmFile file, const FileStamp& stamp)
      : id_(std::move(id)),
        file_(std::move(file)),
        stamp_(stamp),
        hash_text_(to_hex(file_.index().header.content_hash)) {}

  const std::string& id() const { return id_; }
  const FileIndex& index() const { return file_.index(); }
  const ContentHash& hash() const { return index().header.content_hash; }
  const std::string& hash_text() const { return hash_text_; }
  std::uint64_t file_bytes() const { return index().header.file_bytes; }
  int descriptor() const { return file_.file().descriptor(); }
  const FileStamp& stamp() const { return stamp_; }

  /// As PmFile::decode(): the mesh after the first `chunk_count` chunks.
  Result<RefinableMesh> decode(std::size_t chunk_count) const { return file_.decode(chunk_count); }

  /// Reads base and chunks and checks their digests: what a file needs that was written to in
  /// place, as its prologue and hash may have stayed what they were.
  Status check_sections() const;

  /// False once the open file was written to or truncated: its bytes are no longer what the hash
  /// promises. A file replaced by rename stays intact.
  bool intact() const;
  /// The same as of some milliseconds ago: for whoever asks for every packet.
  bool recently_intact() const;

  /// When the name that this mesh stands under is to be looked at again.
  const Look& name_look() const { return name_look_; }

 private:
  std::string id_;
  PmFile file_;
  FileStamp stamp_;
  std::string hash_text_;
  Look name_look_;
  Look file_look_;
  mutable std::atomic<bool> broken_ = false;  // found at the last look
};

using MeshPtr = std::shared_ptr<const MeshFile>;

}  // namespace pmesh
