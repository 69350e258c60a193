// Chunks of all kinds of splits, coded and decoded.
#include "core/pm/split_coder.h"

#include <array>
#include <utility>

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

TEST(SplitCoder, GivesBackBatchesOfAboutAsManySplitsAsAreNamed) {
  const SplitBase base = make_split_base("ball", shapes::icosphere(3), 12, false);
  const std::uint32_t named = base.refinable().vertex_count() / 32;
  for (std::uint32_t count = named - 1; count <= named + 2; ++count) {
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

// A batch of every seventh vertex, up to the middle one.
void add_first_half(RandomChunks& chunks) {
  std::vector<VertexId> wanted;
  for (std::uint32_t v = 0; v < chunks.mesh().vertex_count() / 2; v += 7) wanted.emplace_back(v);
  chunks.add_batch(wanted);
}

std::vector<VertexId> rest_of_sweep(RandomChunks& chunks) {
  const auto rest = chunks.state().rest_of_sweep();
  return {rest.begin(), rest.end()};
}

TEST(SplitCoder, GivesBackABatchThatGoesOnInTheSameChunkAndInTheNext) {
  const SplitBase base = make_split_base("ball", shapes::icosphere(3), 12, false);
  for (const bool other_chunk : {false, true}) {
    RandomChunks chunks(base, 1);
    std::vector<RandomChunks::Chunk> file;
    add_first_half(chunks);
    if (other_chunk) file.push_back(chunks.finish_chunk());
    const std::uint32_t before = chunks.mesh().vertex_count();
    chunks.add_batch(rest_of_sweep(chunks), true);
    EXPECT_GT(chunks.mesh().vertex_count(), before);
    file.push_back(chunks.finish_chunk());
    expect_decoded(base, file, chunks.mesh());
  }
}

// Rings of meshes that do not fit the caches are walked ahead of their turn.
TEST(SplitCoder, GivesBackBatchesOfALargeMesh) {
  const SplitBase base = make_split_base("grid", shapes::grid(260, 260), 12, false);
  RandomChunks chunks(base, 1);
  std::vector<VertexId> wanted;
  for (std::uint32_t v = 0; v < chunks.mesh().vertex_count() / 2; v += 10) wanted.emplace_back(v);
  chunks.add_batch(wanted);
  const std::uint32_t swept = chunks.mesh().vertex_count();
  chunks.add_batch(rest_of_sweep(chunks), true);
  EXPECT_GT(chunks.mesh().vertex_count(), swept);
  const std::vector file = {chunks.finish_chunk()};
  expect_decoded(base, file, chunks.mesh());
}

TEST(SplitCoder, GivesBackABatchThatGoesOnAfterNamedOnesOrWhatHasArrivedSince) {
  const SplitBase base = make_split_base("grid", shapes::grid(20, 20), 12, false);
  RandomChunks chunks(base, 1);
  add_first_half(chunks);
  chunks.add_batch(std::vector{VertexId(17), VertexId(200)});
  std::vector file = {chunks.finish_chunk()};
  const std::uint32_t before = chunks.mesh().vertex_count();
  const LatticeMesh more = make_split_base("more", shapes::grid(9, 9), 12, false).mesh;
  chunks.arrive(more);
  chunks.add_batch(rest_of_sweep(chunks), true);
  ASSERT_GT(chunks.mesh().vertex_count(), before + more.positions.size());
  file.push_back(chunks.finish_chunk());

  RefinableMesh mesh = base.refinable();
  SplitDecoder decoder(mesh);
  ASSERT_TRUE(decoder.decode(file[0].bytes, file[0].splits, base.header, mesh).ok());
  ASSERT_EQ(mesh.vertex_count(), before);
  ASSERT_TRUE(mesh.append(more).ok());
  ASSERT_TRUE(decoder.decode(file[1].bytes, file[1].splits, base.header, mesh).ok());
  expect_same(mesh, chunks.mesh(), base.name);
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

// One split's count and the batch's order, and no change of weights.
Bytes chunk_of(std::initializer_list<BatchOrder> batches) {
  ChunkWriter writer;
  SplitModel model;
  for (const BatchOrder order : batches) {
    writer.raw(5, 0);
    writer.bit(model.goes_on, order == BatchOrder::rest_of_sweep);
    if (order == BatchOrder::rest_of_sweep) continue;
    writer.bit(model.sweeps, order == BatchOrder::sweep);
    constexpr std::size_t kWeights = kFanClasses * 6 + 3;
    for (std::size_t i = 0; i < kWeights; ++i) writer.bit(model.weight_length[0], false);
  }
  return std::move(writer).finish(40);
}

TEST(SplitDecoder, RefusesABatchThatGoesOnWithNoSweep) {
  const SplitBase base = make_split_base("grid", shapes::grid(2, 2), 12, false);
  EXPECT_EQ(error_of(base, chunk_of({BatchOrder::rest_of_sweep}), 1),
            "batch after split 0: a batch has more splits than the mesh has vertices to split");
}

TEST(SplitDecoder, RefusesABatchThatGoesOnWhenNothingIsLeftOfTheSweep) {
  const SplitBase base = make_split_base("triangle", shapes::isolated_triangles(1), 8, false);
  RefinableMesh mesh = base.refinable();
  BatchMesh state(mesh);
  SplitModel model;
  ChunkWriter writer;
  const SplitSite ear{mesh.connectivity().outgoing(VertexId(2)), 0, SplitKind::border_first};
  std::vector<BatchSplit> batch = {{{ear, {}}, VertexId(2)}};
  SplitCoder<ChunkWriter> coder(writer, base.header, model, mesh, state);
  ASSERT_TRUE(coder.code(batch, 1, BatchOrder::sweep, model.parameters).ok());
  ASSERT_TRUE(state.apply(batch, mesh).ok());
  EXPECT_TRUE(state.rest_of_sweep().empty());
  batch[0] = {{{mesh.connectivity().outgoing(VertexId(0)), 0, SplitKind::border_first}, {}},
              VertexId(0)};
  EXPECT_FALSE(coder.code(batch, 1, BatchOrder::rest_of_sweep).ok());
  EXPECT_EQ(error_of(base, std::move(writer).finish(40), 2),
            "batch after split 1: a batch has more splits than the mesh has vertices to split");
}

// Else a chunk of a few bytes a sweep could keep a decoder busy with a large mesh for ever.
TEST(SplitDecoder, RefusesASweepTooSoonAfterAnother) {
  const SplitBase base = make_split_base("grid", shapes::grid(20, 20), 12, false);
  RefinableMesh mesh = base.refinable();
  BatchMesh state(mesh);
  SplitModel model;
  ChunkWriter writer;
  SplitCoder<ChunkWriter> coder(writer, base.header, model, mesh, state);
  for (const VertexId v : {VertexId(1), VertexId(2)}) {
    const SplitSite ear{mesh.connectivity().outgoing(v), 0, SplitKind::border_first};
    std::vector<BatchSplit> batch = {{{ear, {}}, v}};
    const Status coded = coder.code(batch, 1, BatchOrder::sweep, model.parameters);
    EXPECT_EQ(coded.ok(), v == VertexId(1));
    ASSERT_TRUE(state.apply(batch, mesh).ok());
  }
  EXPECT_EQ(error_of(base, std::move(writer).finish(40), 2),
            "batch after split 1: a sweep begins too soon after the one before");
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
