#include "core/pm/verify.h"

#include <algorithm>

#include "core/pm/base_codec.h"
#include "core/pm/digest.h"
#include "core/pm/pm_file.h"
#include "core/pm/stream_decoder.h"

namespace pmesh {
namespace {

Status check_digest(ByteView section, const SectionDigest& expected, const std::string& where) {
  if (digest_section(section) != expected) return bad_input(where + ": wrong digest");
  return {};
}

Status check_box(const FileHeader& header, std::span<const Vec3i> positions) {
  Vec3i low = positions.front(), high = low;
  for (const Vec3i p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  if (low != header.box_low || high != header.box_high) return bad_input("wrong bounding box");
  return {};
}

// Feeds every section to `decoder`, checking digests on the way.
Status replay(const PmFile& file, StreamDecoder& decoder) {
  const FileIndex& index = file.index();
  const Result<Bytes> prologue = file.read(0, index.prologue_bytes);
  if (!prologue) return prologue.error();
  if (Status fed = decoder.feed(*prologue); !fed) return fed;
  const Result<Bytes> base = file.read(index.prologue_bytes, index.base_end());
  if (!base) return base.error();
  if (Status fed = decoder.feed(*base); !fed) return fed;
  if (Status s = check_digest(*base, index.header.base_digest, "base mesh"); !s) return s;
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    const Result<Bytes> chunk = file.read(index.chunks[c].offset, index.chunks[c].end());
    if (!chunk) return chunk.error();
    if (Status fed = decoder.feed(*chunk); !fed) return fed;
    const std::string where = "chunk " + std::to_string(c);
    if (Status s = check_digest(*chunk, index.chunks[c].digest, where); !s) return s;
  }
  return {};
}

Status check_content(const PmFile& file, StreamDecoder& decoder) {
  if (!file.complete()) {
    return bad_input(
        "incomplete: " + std::to_string(file.index().header.file_bytes - file.bytes_on_disk()) +
        " bytes are missing");
  }
  if (Status s = replay(file, decoder); !s) return s;
  if (Status s = decoder.mesh().connectivity().validate(); !s) return s;
  return check_box(file.index().header, decoder.mesh().positions());
}

// A file that breaks its format has failed verification; other errors stay what they are.
Error as_failure(Error error) {
  if (error.code == ErrorCode::bad_input) error.code = ErrorCode::verification;
  return error;
}

}  // namespace

Result<VerifiedFile> verify_file(const std::string& path) {
  const Result<PmFile> file = PmFile::open(path);
  if (!file) return as_failure(file.error());
  StreamDecoder decoder(decode_base);
  if (Status s = check_content(*file, decoder); !s) return prefixed(path, as_failure(s.error()));
  return VerifiedFile{file->index(), decoder.mesh().snapshot()};
}

}  // namespace pmesh
