// Chunks of all kinds of splits, coded and decoded.
#include "core/pm/split_coder.h"

#include <gtest/gtest.h>

#include "core/pm/chunk_reader.h"
#include "core/pm/split_decoder.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

void expect_same(const RefinableMesh& a, const RefinableMesh& b, const std::string& name) {
  EXPECT_EQ(a.snapshot().positions, b.snapshot().positions) << name;
  EXPECT_EQ(a.snapshot().triangles, b.snapshot().triangles) << name;
}

// Decodes `file` onto `base`, and back to it.
void expect_decoded(const SplitBase& base, const std::vector<RandomChunks::Chunk>& file,
                    const RefinableMesh& expected) {
  RefinableMesh mesh = base.refinable();
  SplitDecoder decoder(mesh);
  for (const RandomChunks::Chunk& chunk : file) {
    const Status decoded = decoder.decode(chunk.bytes, chunk.splits, base.header, mesh);
    ASSERT_TRUE(decoded.ok()) << base.name << ": " << decoded.error().message;
  }
  expect_same(mesh, expected, base.name);
  EXPECT_TRUE(mesh.connectivity().validate().ok()) << base.name;
  mesh.set_steps(0);
  expect_same(mesh, base.refinable(), base.name);
}

TEST(SplitCoder, GivesBackRandomSplitsOfEveryKindOfMesh) {
  for (const SplitBase& base : split_bases()) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      RandomChunks chunks(base, seed);
      const auto file = random_file(chunks);
      EXPECT_GT(file[0].splits, 0u) << base.name;
      expect_decoded(base, file, chunks.mesh());
    }
  }
}

TEST(SplitCoder, GivesBackBatchesJustAroundTheSparseOnes) {
  const SplitBase base = make_split_base("ball", shapes::icosphere(3), 12, false);
  const std::uint32_t sparse = base.refinable().vertex_count() / kSparseBatch;
  for (std::uint32_t count = sparse - 1; count <= sparse + 2; ++count) {
    RandomChunks chunks(base, count);
    std::vector<VertexId> wanted;
    for (std::uint32_t v = 0; v < count; ++v) wanted.emplace_back(29 * v);
    chunks.add_batch(wanted);
    const std::vector file = {chunks.finish_chunk()};
    EXPECT_EQ(file[0].splits, count);
    expect_decoded(base, file, chunks.mesh());
  }
}

TEST(SplitCoder, GivesBackTheFirstAndTheLastVertex) {
  const SplitBase base = make_split_base("grid", shapes::grid(20, 20), 12, false);
  const VertexId last(base.refinable().vertex_count() - 1);
  RandomChunks chunks(base, 1);
  chunks.add_batch(std::vector{VertexId(0)});
  chunks.add_batch(std::vector{last});
  chunks.add_batch(std::vector{VertexId(0), last});
  const std::vector file = {chunks.finish_chunk()};
  EXPECT_EQ(file[0].splits, 4u);
  expect_decoded(base, file, chunks.mesh());
}

// Many batches of one split at a vertex of very many faces: each must be of bounded cost.
TEST(SplitCoder, SplitsAHubOfAHundredThousandFacesOneByOne) {
  for (const bool border : {false, true}) {
    const IndexedMesh shape = border ? shapes::border_hub(100'000) : shapes::hub(100'000);
    const SplitBase base = make_split_base("hub", shape, 24, true);
    RandomChunks chunks(base, 1);
    for (int k = 0; k < 2'000; ++k) chunks.add_batch(std::vector{VertexId(0)});
    const std::vector file = {chunks.finish_chunk()};
    EXPECT_GT(file[0].splits, 1'000u);
    expect_decoded(base, file, chunks.mesh());
  }
}

RandomChunks::Chunk grid_chunk(const SplitBase& base) {
  RandomChunks chunks(base, 1);
  chunks.add_batch(40);
  chunks.add_batch(10);
  return chunks.finish_chunk();
}

std::string error_of(const SplitBase& base, const Bytes& bytes, std::uint32_t splits) {
  RefinableMesh mesh = base.refinable();
  const Status decoded = SplitDecoder(mesh).decode(bytes, splits, base.header, mesh);
  EXPECT_TRUE(mesh.connectivity().validate().ok());
  return decoded ? "none" : decoded.error().message;
}

TEST(SplitDecoder, RefusesAChunkOfFewerSplitsThanItsBytes) {
  const SplitBase base = make_split_base("grid", shapes::grid(12, 9), 12, false);
  const auto [bytes, splits] = grid_chunk(base);
  EXPECT_EQ(error_of(base, bytes, splits), "none");
  for (std::uint32_t fewer = 1; fewer < splits; ++fewer) {
    EXPECT_NE(error_of(base, bytes, fewer), "none") << fewer;
  }
  EXPECT_NE(error_of(base, bytes, 0), "none");
}

TEST(SplitDecoder, RefusesAChunkThatClaimsMoreSplitsThanItHolds) {
  const SplitBase base = make_split_base("grid", shapes::grid(12, 9), 12, false);
  const auto [bytes, splits] = grid_chunk(base);
  for (const std::uint32_t more : {1u, 2u, 1000u, 4'000'000'000u}) {
    EXPECT_NE(error_of(base, bytes, splits + more), "none") << more;
  }
}

TEST(SplitDecoder, RefusesBytesThatAreLeftOver) {
  const SplitBase base = make_split_base("grid", shapes::grid(12, 9), 12, false);
  auto [bytes, splits] = grid_chunk(base);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), 50, 0x55);
  EXPECT_NE(error_of(base, bytes, splits), "none");
}

TEST(SplitDecoder, RefusesAnEmptyChunk) {
  const SplitBase base = make_split_base("grid", shapes::grid(2, 2), 12, false);
  EXPECT_NE(error_of(base, {}, 1), "none");
}

TEST(SplitDecoder, NamesTheBatchThatFails) {
  const SplitBase base = make_split_base("grid", shapes::grid(12, 9), 12, false);
  RandomChunks chunks(base, 1);
  chunks.add_batch(std::vector{VertexId(30)});
  const auto [bytes, splits] = chunks.finish_chunk();
  EXPECT_EQ(error_of(base, bytes, splits + 1).rfind("batch after split 1: ", 0), 0u);
}

}  // namespace
}  // namespace pmesh
