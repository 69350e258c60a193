#include "core/pm/encoder.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/box.h"
#include "core/pm/base_codec.h"
#include "core/pm/digest.h"
#include "core/pm/stream_decoder.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

TEST(Encoder, FullResolutionHasExactlyTheQuantisedInputsTriangles) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    StreamDecoder decoder(decode_base);
    const Status fed = decoder.feed(shape.file);
    ASSERT_TRUE(fed.ok()) << shape.name << ": " << fed.error().message;
    ASSERT_TRUE(decoder.complete()) << shape.name;
    EXPECT_TRUE(same_triangles(decoder.mesh().snapshot(), shape.quantised)) << shape.name;
  }
}

TEST(Encoder, EveryChunkEndIsAManifold) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    StreamDecoder decoder(decode_base);
    const FileIndex index = **parse_prologue(shape.file);
    std::size_t from = 0;
    for (std::size_t chunks = 0; chunks <= index.chunks.size(); ++chunks) {
      const std::size_t to = index.prefix_bytes(chunks);
      ASSERT_TRUE(decoder.feed(ByteView(shape.file).subspan(from, to - from)).ok());
      const Status valid = decoder.mesh().connectivity().validate();
      ASSERT_TRUE(valid.ok()) << shape.name << ": " << valid.error().message;
      EXPECT_EQ(decoder.mesh().face_count(), index.faces_after(chunks));
      EXPECT_EQ(decoder.mesh().vertex_count(), index.vertices_after(chunks));
      from = to;
    }
  }
}

RefinableMesh decoded(const EncodedShape& shape) {
  StreamDecoder decoder(decode_base);
  EXPECT_TRUE(decoder.feed(shape.file).ok());
  return std::move(decoder.mesh());
}

TEST(Encoder, TheBoxIsTheFullMeshsAndNotThatOfRelocatedVertices) {
  const EncodedShape shape = encode_relocating_shape("ball", shapes::icosphere(4));
  const FileHeader header = (**parse_prologue(shape.file)).header;
  const auto full = bounding_box(std::span<const Vec3i>(shape.quantised.positions));
  EXPECT_EQ((Box<std::int32_t>{header.box_low, header.box_high}), full);
  RefinableMesh mesh = decoded(shape);
  bool exceeded = false;
  for (std::uint32_t k = 0; k < mesh.known_steps() && !exceeded; ++k) {
    mesh.set_steps(k);
    const auto box = bounding_box(mesh.positions());
    exceeded = box.low.x < full.low.x || box.high.x > full.high.x;
  }
  EXPECT_TRUE(exceeded);  // else this test would prove nothing
}

TEST(Encoder, VerticesThatStayMakeNoRelocations) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    const FileIndex index = **parse_prologue(shape.file);
    const bool expected = shape.name.ends_with("relocating") && !index.chunks.empty();
    EXPECT_EQ(index.header.has_relocations, expected) << shape.name;
  }
}

// Whether a chunk of an icosphere ends within a pair of collapses, with a base of any of some
// sizes.
bool cuts_pairs(std::uint32_t collapses_per_step) {
  bool cut = false;
  for (const std::uint32_t base_faces : {20u, 60u, 100u, 140u, 180u, 220u}) {
    const EncodedShape shape =
        encode_relocating_shape("ball", shapes::icosphere(5), 12, base_faces, collapses_per_step);
    const FileIndex index = **parse_prologue(shape.file);
    for (const ChunkRow& row : index.chunks) {
      cut |= (row.vertices - index.header.base_vertices) % 2 != 0;
    }
  }
  return cut;
}

TEST(Encoder, NoChunkEndsWithinAStepOfTwoCollapses) {
  EXPECT_FALSE(cuts_pairs(2));
  EXPECT_TRUE(cuts_pairs(1));  // else this test would prove nothing
}

TEST(Encoder, GivesTheSameBytesEveryTime) {
  const IndexedMesh mesh = shapes::bumped(shapes::genus(5), 0.01);
  EXPECT_EQ(encode_shape("a", mesh).file, encode_shape("b", mesh).file);
}

TEST(Encoder, AChunkHasHalfTheBytesBeforeItThenAsManyUpToATenthOfAll) {
  const EncodedShape shape = encode_shape("ball", shapes::bumped(shapes::icosphere(6), 0.05), 14);
  const FileIndex index = **parse_prologue(shape.file);
  ASSERT_GE(index.chunks.size(), 8u);
  const double tenth = static_cast<double>(shape.file.size()) / 10;
  for (std::size_t c = 0; c + 1 < index.chunks.size(); ++c) {
    const auto before = static_cast<double>(index.chunks[c].offset - index.prologue_bytes);
    const double target = std::min(std::max(before < 4096 ? before / 2 : before, 800.0), tenth);
    EXPECT_LE(index.chunks[c].bytes, 1.5 * target) << c;
    EXPECT_GE(index.chunks[c].bytes, target / 2.5) << c;  // a batch may end early
  }
}

TEST(Encoder, TheBaseFollowsThePrologueAtOnceWithinTheBlindRead) {
  const EncodedShape shape = encode_shape("ball", shapes::icosphere(5), 14, 200);
  const FileIndex index = **parse_prologue(shape.file);
  EXPECT_LE(index.base_end(), kMaxPrologueBytes);
  EXPECT_EQ(index.prologue_bytes, prologue_size(index));
}

TEST(Encoder, SetsTheContentHash) {
  const EncodedShape shape = encode_shape("tetrahedron", shapes::tetrahedron());
  const FileIndex index = **parse_prologue(shape.file);
  EXPECT_EQ(hash_prologue(ByteView(shape.file).first(index.prologue_bytes)),
            index.header.content_hash);
}

TEST(Encoder, AMeshThatCannotBeDecimatedIsAllBase) {
  const EncodedShape shape = encode_shape("tetrahedron", shapes::tetrahedron());
  const FileIndex index = **parse_prologue(shape.file);
  EXPECT_TRUE(index.chunks.empty());
  EXPECT_EQ(index.base_end(), shape.file.size());
}

}  // namespace
}  // namespace pmesh
