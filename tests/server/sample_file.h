// Made-up PM files: a true prologue before bytes that decode to nothing. The server never looks at
// more than the prologue.
#pragma once

#include <algorithm>
#include <vector>

#include "core/pm/digest.h"
#include "core/pm/format.h"
#include "tests/fixtures/measured.h"

namespace pmesh::testing {

struct SampleFile {
  FileIndex index;
  Bytes bytes;

  std::string hash() const { return to_hex(index.header.content_hash); }
  /// The bytes [begin, end), as text.
  std::string text(std::uint64_t begin, std::uint64_t end) const {
    return {bytes.begin() + static_cast<std::ptrdiff_t>(begin),
            bytes.begin() + static_cast<std::ptrdiff_t>(end)};
  }
  std::string text() const { return text(0, bytes.size()); }
};

inline void append_noise(Bytes& bytes, std::size_t count, std::uint32_t seed) {
  std::uint32_t state = seed * 2654435761u + 1;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 1664525u + 1013904223u;
    bytes.push_back(static_cast<std::uint8_t>(state >> 24));
  }
}

/// Noise in the place of base and chunks, with its true digests in the index.
inline Bytes make_sections(FileIndex& index, std::uint32_t seed) {
  Bytes sections;
  const auto append = [&](std::size_t count) {
    const std::size_t begin = sections.size();
    append_noise(sections, count, seed++);
    return digest_section(ByteView(sections).subspan(begin));
  };
  index.header.base_digest = append(index.header.base_bytes);
  for (ChunkRow& row : index.chunks) row.digest = append(row.bytes);
  return sections;
}

/// A base of 16 faces and 10 vertices in 300 bytes, then chunks of these sizes. Each adds ten
/// vertices and twenty faces, or as many more as its bytes need to be plausible. Another seed gives
/// another file of the same size. The errors are measured if there is one for each chunk.
inline SampleFile make_sample(const std::vector<std::uint32_t>& chunk_bytes = {100, 200, 300},
                              std::uint32_t seed = 1, const std::vector<double>& max_errors = {}) {
  SampleFile sample;
  FileHeader& header = sample.index.header;
  header.vertices = header.base_vertices = 10;
  header.faces = header.base_faces = 16;
  header.base_bytes = 300;
  header.base_crc = seed;
  header.lattice = {.origin = {}, .step = 1, .bits = 12};
  header.box_high = {4095, 4095, 4095};
  header.metric = "melod";
  for (const std::uint32_t bytes : chunk_bytes) {
    const std::uint64_t splits = std::max<std::uint64_t>(10, bytes / kMaxSplitBytes + 1);
    header.vertices += splits;
    header.faces += 2 * splits;
    sample.index.chunks.push_back(
        {.bytes = bytes, .vertices = header.vertices, .faces = header.faces});
  }
  set_errors(sample.index, max_errors);
  const Bytes sections = make_sections(sample.index, seed);
  write_prologue(sample.index);  // for its totals
  header.content_hash = hash_prologue(write_prologue(sample.index));
  sample.bytes = write_prologue(sample.index);
  sample.bytes.insert(sample.bytes.end(), sections.begin(), sections.end());
  return sample;
}

/// The first sample with the measured errors 4, 2 and 1; its box's diagonal is 4095 * sqrt(3).
inline SampleFile make_measured_sample() { return make_sample({100, 200, 300}, 1, {4, 2, 1}); }

}  // namespace pmesh::testing
