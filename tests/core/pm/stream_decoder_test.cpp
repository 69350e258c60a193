#include "core/pm/stream_decoder.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/pm/base_codec.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

LatticeMesh decode_in_cuts(const Bytes& file, const std::vector<std::size_t>& sizes) {
  StreamDecoder decoder(decode_base);
  std::size_t at = 0;
  for (std::size_t k = 0; at < file.size(); ++k) {
    const std::size_t size = std::min(sizes[k % sizes.size()], file.size() - at);
    EXPECT_TRUE(decoder.feed(ByteView(file).subspan(at, size)).ok());
    at += size;
    EXPECT_EQ(decoder.fed_bytes(), at);
  }
  EXPECT_TRUE(decoder.complete());
  return decoder.mesh().snapshot();
}

TEST(StreamDecoder, GivesTheSameMeshWhateverTheCuts) {
  const EncodedShape shape = encode_shape("torus", shapes::bumped(shapes::torus(60, 40), 0.02));
  const LatticeMesh whole = decode_in_cuts(shape.file, {shape.file.size()});
  for (const std::vector<std::size_t>& sizes :
       {std::vector<std::size_t>{1}, {7}, {4096}, {1, 20'000, 3, 500}}) {
    const LatticeMesh cut = decode_in_cuts(shape.file, sizes);
    EXPECT_EQ(cut.positions, whole.positions);
    EXPECT_EQ(cut.triangles, whole.triangles);
  }
}

TEST(StreamDecoder, FeedingOneByteAtATimeEqualsFeedingTheWholeForEveryShape) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    const LatticeMesh whole = decode_in_cuts(shape.file, {shape.file.size()});
    const LatticeMesh cut = decode_in_cuts(shape.file, {1});
    EXPECT_EQ(cut.positions, whole.positions) << shape.name;
    EXPECT_EQ(cut.triangles, whole.triangles) << shape.name;
  }
}

TEST(StreamDecoder, EveryPrefixIsAnLodOrWantsMore) {
  const EncodedShape shape = encode_shape("grid", shapes::bumped(shapes::grid(40, 30), 0.05));
  const FileIndex index = **parse_prologue(shape.file);
  StreamDecoder decoder(decode_base);
  for (std::size_t n = 0; n < shape.file.size(); ++n) {
    EXPECT_EQ(decoder.has_index(), n >= index.prologue_bytes);
    EXPECT_EQ(decoder.has_base(), n >= index.base_end());
    std::size_t chunks = 0;
    while (chunks < index.chunks.size() && n >= index.chunks[chunks].end()) ++chunks;
    ASSERT_EQ(decoder.chunk_count(), chunks);
    if (decoder.has_base()) {
      ASSERT_EQ(decoder.mesh().face_count(), index.faces_after(chunks));
    }
    ASSERT_TRUE(decoder.feed(ByteView(shape.file).subspan(n, 1)).ok());
  }
  EXPECT_TRUE(decoder.complete());
}

TEST(StreamDecoder, TheLodMayBeMovedBetweenFeeds) {
  const EncodedShape shape = encode_shape("ball", shapes::icosphere(4));
  StreamDecoder decoder(decode_base);
  for (std::size_t n = 0; n < shape.file.size(); n += 100) {
    const std::size_t size = std::min<std::size_t>(100, shape.file.size() - n);
    ASSERT_TRUE(decoder.feed(ByteView(shape.file).subspan(n, size)).ok());
    if (decoder.has_base()) decoder.mesh().set_faces(n % 700);
  }
  decoder.mesh().set_finest();
  EXPECT_EQ(decoder.mesh().face_count(), shape.quantised.triangles.size());
}

TEST(StreamDecoder, RefusesBytesAfterTheEnd) {
  EncodedShape shape = encode_shape("tetrahedron", shapes::tetrahedron());
  shape.file.push_back(0);
  StreamDecoder decoder(decode_base);
  EXPECT_EQ(decoder.feed(shape.file).error().message, "bytes follow the last chunk");
}

TEST(StreamDecoder, StaysFailedAndKeepsWhatItHad) {
  EncodedShape shape = encode_shape("ball", shapes::icosphere(4));
  const FileIndex index = **parse_prologue(shape.file);
  shape.file[index.chunks[0].offset] ^= 1;
  StreamDecoder decoder(decode_base);
  const Status fed = decoder.feed(shape.file);
  ASSERT_FALSE(fed.ok());
  EXPECT_EQ(fed.error().message, "chunk 0: wrong checksum");
  EXPECT_EQ(decoder.feed({}).error().message, fed.error().message);
  EXPECT_EQ(decoder.usable_bytes(), index.base_end());
  EXPECT_EQ(decoder.mesh().face_count(), index.header.base_faces);
}

TEST(StreamDecoder, AChunkThatFailsHalfWayLeavesNoTrace) {
  EncodedShape shape = encode_relocating_shape("ball", shapes::icosphere(4));
  const FileIndex index = **parse_prologue(shape.file);
  StreamDecoder sound(decode_base);
  ASSERT_TRUE(sound.feed(ByteView(shape.file).first(index.chunks[0].end())).ok());
  const auto half = static_cast<std::ptrdiff_t>(index.chunks[1].offset + index.chunks[1].bytes / 2);
  std::fill_n(shape.file.begin() + half, 40, std::uint8_t{0xFF});
  DecodeLimits limits;
  limits.verify_checksums = false;
  StreamDecoder decoder(decode_base, limits);
  ASSERT_FALSE(decoder.feed(shape.file).ok());
  decoder.mesh().set_finest();
  EXPECT_EQ(decoder.mesh().snapshot().positions, sound.mesh().snapshot().positions);
  EXPECT_EQ(decoder.mesh().snapshot().triangles, sound.mesh().snapshot().triangles);
  EXPECT_EQ(decoder.usable_bytes(), index.chunks[0].end());
}

TEST(StreamDecoder, HoldsItsLimitsBeforeTakingMemory) {
  const EncodedShape shape = encode_shape("ball", shapes::icosphere(3));
  DecodeLimits limits;
  limits.max_faces = 100;
  StreamDecoder decoder(decode_base, limits);
  const Status fed = decoder.feed(shape.file);
  ASSERT_FALSE(fed.ok());
  EXPECT_EQ(fed.error().code, ErrorCode::out_of_resources);
  EXPECT_FALSE(decoder.has_index());
}

}  // namespace
}  // namespace pmesh
