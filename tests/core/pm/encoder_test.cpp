#include "core/pm/encoder.h"

#include <gtest/gtest.h>

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

TEST(Encoder, GivesTheSameBytesEveryTime) {
  const IndexedMesh mesh = shapes::bumped(shapes::genus(5), 0.01);
  EXPECT_EQ(encode_shape("a", mesh).file, encode_shape("b", mesh).file);
}

TEST(Encoder, ChunksGrowFromFourKibibytesByHalf) {
  const EncodedShape shape = encode_shape("ball", shapes::icosphere(6));
  const FileIndex index = **parse_prologue(shape.file);
  ASSERT_GE(index.chunks.size(), 4u);
  double bound = 4096;
  for (std::size_t c = 0; c + 1 < index.chunks.size(); ++c, bound *= 1.5) {
    EXPECT_LE(index.chunks[c].bytes, bound);
    EXPECT_GT(index.chunks[c].bytes, 0.98 * bound);
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
