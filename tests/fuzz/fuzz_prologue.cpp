// Header and index of a PM file, with and without their checksum. What is accepted must hang
// together, and come back from the bytes that it is written to.
#include <cstdlib>

#include "core/pm/format.h"

namespace {

using namespace pmesh;

void require(bool condition) {
  if (!condition) std::abort();
}

void check_index(const FileIndex& index) {
  require(index.base_end() <= index.header.file_bytes);
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    require(index.chunks[c].offset == index.prefix_bytes(c));
    require(index.faces_after(c) < index.faces_after(c + 1));
    require(index.vertices_after(c) < index.vertices_after(c + 1));
  }
  require(index.prefix_bytes(index.chunks.size()) == index.header.file_bytes);
}

/// Whether an index that was accepted is accepted again from the bytes it is written to.
void check_rewritten(FileIndex index) {
  if (prologue_size(index) > kMaxPrologueBytes) return;
  const FileHeader& header = index.header;
  if (header.metric.size() + header.parameters.size() + header.unit.size() > 64) return;
  const Bytes bytes = write_prologue(index);
  const auto again = parse_prologue(bytes);
  require(again.ok() && again->has_value());
  require((*again)->header.content_hash == header.content_hash);
  require((*again)->chunks.size() == index.chunks.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView bytes(data, size);
  for (const bool verify : {true, false}) {
    const auto parsed = parse_prologue(bytes, {.verify_checksums = verify});
    if (!parsed || !parsed->has_value()) continue;
    check_index(**parsed);
    check_rewritten(**parsed);
  }
  return 0;
}
