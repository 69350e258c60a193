#include "client/verified_prefix.h"

#include <algorithm>
#include <string>

#include "core/pm/digest.h"

namespace pmesh {

Status VerifiedPrefix::append(ByteView bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  Status status = check_whole_sections();
  if (!status) drop_unfinished();
  return status;
}

Status VerifiedPrefix::check_whole_sections() {
  if (!index_) {
    if (Status status = take_prologue(); !status || !index_) return status;
  }
  for (auto end = section_end(); end && *end <= bytes_.size(); end = section_end()) {
    const ByteView section = ByteView(bytes_).subspan(verified_bytes_, *end - verified_bytes_);
    if (Status status = check_section(section); !status) return status;
    if (has_base()) ++chunk_count_;
    verified_bytes_ = static_cast<std::size_t>(*end);
  }
  if (!section_end() && bytes_.size() > verified_bytes_) {
    return damaged("bytes after the end of the PM file");
  }
  return {};
}

Status VerifiedPrefix::take_prologue() {
  Result<std::optional<FileIndex>> parsed = parse_prologue(bytes_, limits_);
  if (!parsed) return parsed.error();
  if (!*parsed) return {};
  const FileIndex& index = **parsed;
  if (hash_prologue(ByteView(bytes_).first(index.prologue_bytes)) != index.header.content_hash) {
    return damaged("header and index do not match the content hash");
  }
  verified_bytes_ = index.prologue_bytes;
  index_ = std::move(*parsed);
  return {};
}

// Where the section ends that begins at verified_bytes_; nothing at the end of the file.
std::optional<std::uint64_t> VerifiedPrefix::section_end() const {
  if (!has_base()) return index_->base_end();
  if (chunk_count_ == index_->chunks.size()) return std::nullopt;
  return index_->chunks[chunk_count_].end();
}

Status VerifiedPrefix::check_section(ByteView section) const {
  const bool is_base = !has_base();
  const SectionDigest& expected =
      is_base ? index_->header.base_digest : index_->chunks[chunk_count_].digest;
  if (digest_section(section) == expected) return {};
  const std::string name = is_base ? "the base mesh" : "chunk " + std::to_string(chunk_count_);
  return Error{ErrorCode::verification, name + " does not match its digest (altered on the way?)"};
}

}  // namespace pmesh
