// The bytes of a PM file from its start, as far as they have come, with every whole section checked
// against the SHA-256 digests of the index, and the index against the content hash. So a cache that
// has been poisoned, or a file replaced under a transfer, is noticed whatever the wire.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/format.h"

namespace pmesh {

class VerifiedPrefix {
 public:
  explicit VerifiedPrefix(const DecodeLimits& limits = {}) : limits_(limits) {}

  /// Takes the bytes that follow those held, in any cuts. Fails if they are no PM file
  /// (bad_input), if header, index or a section do not hold what they claim (verification) or if a
  /// limit is exceeded (out_of_resources); after that verified() still holds
  /// what was checked, and the rest has been dropped.
  Status append(ByteView bytes);

  /// Forgets the bytes after the last whole section.
  void drop_unfinished() { bytes_.resize(verified_bytes_); }

  /// All bytes held, the last section perhaps unfinished.
  std::uint64_t size() const { return bytes_.size(); }
  /// The whole, checked sections. Valid until the next append().
  ByteView verified() const { return ByteView(bytes_).first(verified_bytes_); }
  /// Null until the header and index are whole.
  const FileIndex* index() const { return index_ ? &*index_ : nullptr; }
  bool has_base() const { return index_ && verified_bytes_ >= index_->base_end(); }
  /// Whole chunks held.
  std::size_t chunk_count() const { return chunk_count_; }

 private:
  Status check_whole_sections();
  Status take_prologue();
  std::optional<std::uint64_t> section_end() const;
  Status check_section(ByteView section) const;

  DecodeLimits limits_;
  Bytes bytes_;
  std::size_t verified_bytes_ = 0;
  std::optional<FileIndex> index_;
  std::size_t chunk_count_ = 0;
};

}  // namespace pmesh
