#include "protocol/apply_wish.h"

#include <gtest/gtest.h>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/client/sample.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using test::sample_file;
using test::sample_index;
using test::wish;

// The sample, decoded up to `bytes`.
StreamDecoder decoded(std::uint64_t bytes = sample_file().size()) {
  StreamDecoder decoder(decode_base);
  EXPECT_TRUE(decoder.feed(ByteView(sample_file()).first(static_cast<std::size_t>(bytes))).ok());
  return decoder;
}

AppliedWish apply(const char* query, StreamDecoder& decoder) {
  return *apply_wish(wish(query), decoder.index(), decoder.mesh());
}

TEST(ApplyWish, GivesEverythingByDefault) {
  StreamDecoder decoder = decoded();
  const AppliedWish applied = apply("", decoder);
  EXPECT_EQ(applied.faces, sample_index().header.faces);
  EXPECT_EQ(applied.vertices, sample_index().header.vertices);
  EXPECT_TRUE(applied.reached);
}

TEST(ApplyWish, GivesTheLargestLodWithAtMostThatManyFaces) {
  StreamDecoder decoder = decoded();
  const AppliedWish applied = apply("faces=1001", decoder);
  EXPECT_LE(applied.faces, 1001u);
  decoder.mesh().set_steps(decoder.mesh().applied_steps() + 1);
  EXPECT_GT(decoder.mesh().face_count(), 1001u);
}

TEST(ApplyWish, GivesExactlyThatManyVertices) {
  StreamDecoder decoder = decoded();
  EXPECT_EQ(apply("vertices=777", decoder).vertices, 777u);
}

TEST(ApplyWish, TakesARatioOfTheFaces) {
  StreamDecoder decoder = decoded();
  const AppliedWish by_ratio = apply("ratio=0.25", decoder);
  const std::string faces = "faces=" + std::to_string(sample_index().header.faces / 4);
  EXPECT_EQ(by_ratio.faces, apply(faces.c_str(), decoder).faces);
}

TEST(ApplyWish, GivesWholeChunksForBytes) {
  StreamDecoder decoder = decoded();
  const std::string bytes = "bytes=" + std::to_string(sample_index().chunks[1].end() + 1);
  EXPECT_EQ(apply(bytes.c_str(), decoder).faces, sample_index().chunks[1].faces);
}

TEST(ApplyWish, GivesTheFirstChunkEndNearEnough) {
  StreamDecoder decoder = decoded();
  const AppliedWish applied = apply("error=5", decoder);
  EXPECT_EQ(applied.faces, sample_index().chunks[1].faces);
  EXPECT_EQ(applied.vertices, sample_index().chunks[1].vertices);
  EXPECT_TRUE(applied.reached);
}

TEST(ApplyWish, GivesEverythingForAnErrorOutOfReach) {
  StreamDecoder decoder = decoded();
  const AppliedWish applied = apply("error=1e-9%", decoder);
  EXPECT_EQ(applied.faces, sample_index().header.faces);
  EXPECT_FALSE(applied.reached);
}

TEST(ApplyWish, RefusesAnErrorOfAFileWithoutMeasuredErrors) {
  StreamDecoder decoder(decode_base);
  ASSERT_TRUE(decoder.feed(test::other_file()).ok());
  EXPECT_FALSE(apply_wish(wish("error=5"), decoder.index(), decoder.mesh()).ok());
}

TEST(ApplyWish, GivesTheBaseBelowTheBase) {
  StreamDecoder decoder = decoded();
  for (const char* query : {"faces=1", "vertices=1", "ratio=1e-9", "bytes=1", "faces=0"}) {
    const AppliedWish applied = apply(query, decoder);
    EXPECT_EQ(applied.faces, sample_index().header.base_faces) << query;
    EXPECT_FALSE(applied.reached) << query;
  }
}

TEST(ApplyWish, SaysIfThePrefixIsTooShortForTheWish) {
  StreamDecoder decoder = decoded(sample_index().chunks[1].end());
  const std::uint64_t known = sample_index().chunks[1].faces;
  EXPECT_TRUE(apply(("faces=" + std::to_string(known)).c_str(), decoder).reached);
  const AppliedWish beyond = apply(("faces=" + std::to_string(known + 2)).c_str(), decoder);
  EXPECT_FALSE(beyond.reached);
  EXPECT_EQ(beyond.faces, known);
  EXPECT_FALSE(apply("", decoder).reached);
  EXPECT_TRUE(apply("error=4", decoder).reached);
  EXPECT_FALSE(apply("error=3", decoder).reached);
}

TEST(ApplyWish, DoesNotDependOnTheLodBefore) {
  StreamDecoder decoder = decoded();
  const std::uint32_t from_fine = apply("faces=500", decoder).faces;
  (void)apply("faces=1", decoder);
  EXPECT_EQ(apply("faces=500", decoder).faces, from_fine);
}

TEST(ApplyWish, NeverNeedsMoreThanTheBytesItResolvesTo) {
  for (const char* query : {"faces=100", "faces=999", "vertices=640", "ratio=0.5", "bytes=20000",
                            "error=4", "error=100%", "error=0"}) {
    StreamDecoder whole = decoded();
    StreamDecoder prefix = decoded(resolve(wish(query), sample_index())->end);
    const AppliedWish expected = apply(query, whole);
    const AppliedWish applied = apply(query, prefix);
    EXPECT_EQ(applied.faces, expected.faces) << query;
    EXPECT_EQ(applied.vertices, expected.vertices) << query;
    EXPECT_EQ(applied.reached, expected.reached) << query;
  }
}

// Closed pieces: no border splits, so that counts resolve exactly.
const Bytes& closed_pieces() {
  static const Bytes file = [] {
    IndexedMesh mesh;
    for (int k = 0; k < 1500; ++k) {
      const IndexedMesh piece = k % 3 == 0 ? shapes::icosphere(1) : shapes::octahedron();
      mesh = shapes::joined(std::move(mesh),
                            shapes::moved(piece, {3.0 * (k % 40), 3.0 * (k / 40), 0}));
    }
    return test::make_pm_file(mesh);
  }();
  return file;
}

TEST(ApplyWish, TakesNewComponentsAsTheWishResolves) {
  StreamDecoder whole(decode_base);
  ASSERT_TRUE(whole.feed(closed_pieces()).ok());
  ASSERT_TRUE(whole.index().header.has_arrivals);
  for (const char* key : {"faces=", "vertices="}) {
    for (int count = 500; count < 30'000; count += 251) {
      const std::string query = key + std::to_string(count);
      const Resolution resolution = *resolve(wish(query.c_str()), whole.index());
      const AppliedWish applied = apply(query.c_str(), whole);
      EXPECT_EQ(applied.faces, resolution.faces) << query;
      EXPECT_EQ(applied.vertices, resolution.vertices) << query;
      EXPECT_EQ(applied.reached, resolution.reached) << query;
      EXPECT_LE(applied.vertices, whole.index().vertices_after(resolution.chunk_count)) << query;
    }
  }
}

TEST(ApplyWish, RefusesChunksThatTheFileDoesNotHave) {
  StreamDecoder decoder = decoded();
  EXPECT_FALSE(apply_wish(wish("chunks=0-9999"), decoder.index(), decoder.mesh()).ok());
}

}  // namespace
}  // namespace pmesh
