// Made-up PM files: a true prologue before bytes that decode to nothing. The server never looks at
// more than the prologue.
#pragma once

#include <vector>

#include "core/pm/digest.h"
#include "core/pm/format.h"

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

/// A base of 16 faces and 10 vertices in 300 bytes, then chunks of these sizes that add ten
/// vertices and twenty faces each. Another seed gives another file of the same size.
inline SampleFile make_sample(const std::vector<std::uint32_t>& chunk_bytes = {100, 200, 400},
                              std::uint32_t seed = 1) {
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
    header.vertices += 10;
    header.faces += 20;
    sample.index.chunks.push_back(
        {.bytes = bytes, .vertices = header.vertices, .faces = header.faces});
  }
  write_prologue(sample.index);  // for its totals
  header.content_hash = hash_prologue(write_prologue(sample.index));
  sample.bytes = write_prologue(sample.index);
  append_noise(sample.bytes, sample.index.header.file_bytes - sample.bytes.size(), seed);
  return sample;
}

}  // namespace pmesh::testing
