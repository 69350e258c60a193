#include "core/pm/section_meter.h"

#include <numeric>

#include <gtest/gtest.h>

#include "core/pm/mesh_section.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using SectionBits = std::array<double, kSplitSections>;

double total(const SectionBits& bits) { return std::accumulate(bits.begin(), bits.end(), 0.0); }

// Of all chunks, without their new components.
std::size_t bytes_of_splits(const Bytes& file, const FileIndex& index) {
  std::size_t bytes = 0;
  for (const ChunkRow& row : index.chunks) {
    bytes += chunk_parts(ByteView(file).subspan(row.offset, row.bytes), row)->splits.size();
  }
  return bytes;
}

double bits_of(const SectionBits& bits, SplitSection section) {
  return bits[static_cast<std::size_t>(section)];
}

TEST(SectionMeter, SectionsAddUpToTheChunksBytesButForTheirEnds) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    const FileIndex index = **parse_prologue(shape.file);
    const auto bits = measure_sections(shape.file, index);
    ASSERT_TRUE(bits.ok()) << shape.name << ": " << bits.error().message;
    const auto bytes = static_cast<double>(bytes_of_splits(shape.file, index));
    const auto chunks = static_cast<double>(index.chunks.size());
    EXPECT_LE(total(bits->split_bits) / 8, bytes + 1e-3) << shape.name;
    EXPECT_GE(total(bits->split_bits) / 8, bytes - 8 * chunks) << shape.name;
  }
}

TEST(SectionMeter, CountsRelocationsOnlyWhereThereAreSome) {
  const IndexedMesh ball = shapes::icosphere(4);
  const EncodedShape still = encode_shape("still", ball);
  const EncodedShape moving = encode_relocating_shape("moving", ball);
  const auto none = measure_sections(still.file, **parse_prologue(still.file));
  const auto some = measure_sections(moving.file, **parse_prologue(moving.file));
  EXPECT_EQ(bits_of(none->split_bits, SplitSection::relocations), 0);
  EXPECT_GT(bits_of(some->split_bits, SplitSection::relocations), 1000);
  for (const auto section :
       {SplitSection::batches, SplitSection::marks, SplitSection::cuts, SplitSection::positions}) {
    EXPECT_GT(bits_of(none->split_bits, section), 0);
  }
}

TEST(SectionMeter, MeasuresAPartialFileUpToItsLastWholeChunk) {
  const EncodedShape shape = encode_shape("ball", shapes::icosphere(5));
  const FileIndex index = **parse_prologue(shape.file);
  ASSERT_GE(index.chunks.size(), 2u);
  const std::size_t two = index.chunks[1].end();
  const auto one = measure_sections(ByteView(shape.file).first(two - 1), index);
  ASSERT_TRUE(one.ok());
  EXPECT_NEAR(total(one->split_bits) / 8, index.chunks[0].bytes, 8);
}

TEST(SectionMeter, RefusesADamagedChunk) {
  EncodedShape shape = encode_shape("ball", shapes::icosphere(4));
  const FileIndex index = **parse_prologue(shape.file);
  Bytes& file = shape.file;
  std::fill(file.begin() + static_cast<std::ptrdiff_t>(index.base_end()), file.end(), 0xFF);
  EXPECT_FALSE(measure_sections(file, index).ok());
}

}  // namespace
}  // namespace pmesh
