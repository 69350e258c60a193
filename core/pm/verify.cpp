#include "core/pm/verify.h"

#include <utility>

#include "core/base/box.h"
#include "core/files/out_of_memory.h"
#include "core/pm/base_codec.h"
#include "core/pm/digest.h"
#include "core/pm/pm_file.h"
#include "core/pm/stream_decoder.h"

namespace pmesh {
namespace {

Status check_digest(ByteView section, const SectionDigest& expected, const std::string& where) {
  if (digest_section(section) != expected) return damaged(where + ": wrong digest");
  return {};
}

Status check_box(const FileHeader& header, std::span<const Vec3i> positions) {
  const Box<std::int32_t> box = bounding_box(positions);
  if (box.low != header.box_low || box.high != header.box_high) {
    return damaged("wrong bounding box");
  }
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
    return damaged(
        "incomplete: " + std::to_string(file.index().header.file_bytes - file.bytes_on_disk()) +
        " bytes are missing");
  }
  if (Status s = replay(file, decoder); !s) return s;
  if (Status s = decoder.mesh().connectivity().validate(); !s) return damaged(s.error().message);
  return check_box(file.index().header, decoder.mesh().positions());
}

}  // namespace

Result<VerifiedFile> verify_file(const std::string& path) {
  const Result<PmFile> file = PmFile::open(path);
  if (!file) return file.error();
  Result<LatticeMesh> full = catching_out_of_memory([&]() -> Result<LatticeMesh> {
    StreamDecoder decoder(decode_base);
    if (Status s = check_content(*file, decoder); !s) return s.error();
    return decoder.mesh().snapshot();
  });
  if (!full) return prefixed(path, full.error());
  return VerifiedFile{file->index(), std::move(*full)};
}

}  // namespace pmesh
