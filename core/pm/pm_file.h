// A PM file on disk, whole or partial.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/result.h"
#include "core/files/read_file.h"
#include "core/pm/format.h"
#include "core/pm/stream_decoder.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// Threads: const members may be called at the same time.
class PmFile {
 public:
  /// Reads and checks header and index, the content hash among them; no bodies. A partial file is
  /// welcome as long as it holds the base. Errors begin with the path: bad_input if the file is no
  /// PM file, verification if it is damaged or does not hold its base, with what is missing.
  static Result<PmFile> open(const std::string& path);

  const FileIndex& index() const { return index_; }
  const RandomAccessFile& file() const { return file_; }
  std::uint64_t bytes_on_disk() const { return file_.size(); }
  bool complete() const { return file_.size() == index_.header.file_bytes; }
  /// Chunks that are on disk to their last byte.
  std::size_t whole_chunks() const;

  /// Decodes base and the first `chunk_count` chunks, checking CRCs.
  /// Precondition: chunk_count <= whole_chunks().
  Result<RefinableMesh> decode(std::size_t chunk_count) const;

  /// The bytes [begin, end) of the file.
  Result<Bytes> read(std::uint64_t begin, std::uint64_t end) const;

 private:
  PmFile(RandomAccessFile file, FileIndex index)
      : file_(std::move(file)), index_(std::move(index)) {}

  Status feed_section(std::uint64_t begin, std::uint64_t end, StreamDecoder& decoder) const;

  RandomAccessFile file_;
  FileIndex index_;
};

}  // namespace pmesh
