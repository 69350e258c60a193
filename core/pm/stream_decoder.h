// The push parser: takes a PM file's bytes from the first on, in any cuts, and grows a
// RefinableMesh. The same result whatever the cuts.
//
// No files, no third party, no threads, no clock, no exceptions: the same source runs in the
// browser. Every byte is treated as hostile; memory is bounded by the DecodeLimits.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"
#include "core/pm/format.h"
#include "core/pm/mesh_section.h"
#include "core/pm/split_decoder.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

class StreamDecoder {
 public:
  explicit StreamDecoder(BaseDecoder decode_base, const DecodeLimits& limits = {});

  /// Takes the next bytes. Bytes of a section that is not yet whole are kept (at most 16 KiB of
  /// prologue, or one base or chunk). Whole chunks are applied to mesh() at once, leaving its
  /// finest LOD standing. After an error the decoder stays failed and repeats the error; the
  /// whole sections decoded before remain. Bytes after the last section are an error.
  /// Errors: as parse_prologue; verification for all that is wrong behind the prologue.
  Status feed(ByteView bytes);

  /// Everything fed so far in whole sections, from the file's start: feed from here to resume.
  std::uint64_t usable_bytes() const { return usable_bytes_; }
  std::uint64_t fed_bytes() const { return usable_bytes_ + pending_.size(); }

  bool has_index() const { return index_.has_value(); }
  bool has_base() const { return mesh_.has_value(); }
  std::size_t chunk_count() const { return chunk_count_; }  ///< Chunks decoded.
  bool complete() const { return has_base() && usable_bytes_ == index_->header.file_bytes; }

  /// Precondition: has_index().
  const FileIndex& index() const { return *index_; }
  /// Precondition: has_base(). The LOD may be moved freely between calls of feed().
  RefinableMesh& mesh() { return *mesh_; }
  const RefinableMesh& mesh() const { return *mesh_; }

 private:
  std::uint64_t section_bytes() const;
  void take_prologue();
  void take_whole_section(ByteView section);
  Status take_base(ByteView section);
  Status take_chunk(ByteView section);
  Status decode_chunk(ByteView section, std::size_t chunk);

  BaseDecoder decode_base_;
  DecodeLimits limits_;
  std::optional<FileIndex> index_;
  std::optional<RefinableMesh> mesh_;
  std::optional<SplitDecoder> splits_;
  std::size_t chunk_count_ = 0;
  std::uint64_t usable_bytes_ = 0;
  Bytes pending_;
  Status status_;
};

}  // namespace pmesh
