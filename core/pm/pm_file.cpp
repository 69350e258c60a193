#include "core/pm/pm_file.h"

#include <algorithm>
#include <cassert>

#include "core/files/out_of_memory.h"
#include "core/pm/base_codec.h"
#include "core/pm/digest.h"

namespace pmesh {
namespace {

Result<FileIndex> parse_start(ByteView start, std::uint64_t file_bytes) {
  Result<std::optional<FileIndex>> parsed = parse_prologue(start);
  if (!parsed) return parsed.error();
  if (!parsed->has_value()) return damaged("the file ends inside header and index");
  FileIndex& index = **parsed;
  if (hash_prologue(start.first(index.prologue_bytes)) != index.header.content_hash) {
    return damaged("header and index: wrong content hash");
  }
  if (file_bytes < index.base_end()) {
    return damaged("the file ends inside the base mesh: " +
                   std::to_string(index.base_end() - file_bytes) + " bytes are missing");
  }
  if (file_bytes > index.header.file_bytes) {
    return damaged("the file is " + std::to_string(file_bytes - index.header.file_bytes) +
                   " bytes too long");
  }
  return std::move(index);
}

}  // namespace

Result<PmFile> PmFile::open(const std::string& path) {
  Result<RandomAccessFile> file = RandomAccessFile::open(path);
  if (!file) return file.error();
  Bytes start(std::min<std::uint64_t>(file->size(), kMaxPrologueBytes));
  if (Status read = file->read(0, start); !read) return read.error();
  Result<FileIndex> index = parse_start(start, file->size());
  if (!index) return prefixed(path, index.error());
  return PmFile(std::move(*file), std::move(*index));
}

std::size_t PmFile::whole_chunks() const {
  const auto cut =
      std::partition_point(index_.chunks.begin(), index_.chunks.end(),
                           [&](const ChunkRow& row) { return row.end() <= bytes_on_disk(); });
  return static_cast<std::size_t>(cut - index_.chunks.begin());
}

Result<Bytes> PmFile::read(std::uint64_t begin, std::uint64_t end) const {
  return catching_out_of_memory([&]() -> Result<Bytes> {
    Bytes bytes(end - begin);
    if (Status read = file_.read(begin, bytes); !read) return read.error();
    return bytes;
  });
}

Status PmFile::feed_section(std::uint64_t begin, std::uint64_t end, StreamDecoder& decoder) const {
  const Result<Bytes> section = read(begin, end);
  if (!section) return section.error();
  return catching_out_of_memory([&] { return decoder.feed(*section); });
}

Result<RefinableMesh> PmFile::decode(std::size_t chunk_count) const {
  assert(chunk_count <= whole_chunks());
  StreamDecoder decoder(decode_base);
  Status fed = feed_section(0, index_.prologue_bytes, decoder);
  std::uint64_t begin = index_.prologue_bytes;
  for (std::size_t chunks = 0; fed.ok() && chunks <= chunk_count; ++chunks) {
    const std::uint64_t end = index_.prefix_bytes(chunks);
    fed = feed_section(begin, end, decoder);
    begin = end;
  }
  if (!fed) return prefixed(file_.path(), fed.error());
  return std::move(decoder.mesh());
}

}  // namespace pmesh
