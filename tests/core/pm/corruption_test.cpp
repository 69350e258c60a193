// Hostile files: every cut, and thousands of flipped bytes, with and without checksums to stop
// them early. Under ASan and UBSan these tests are the proof that no byte is trusted.
#include <random>

#include <gtest/gtest.h>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

// Decodes `file`; whatever comes of it must be an error or a valid mesh. True if no error.
bool survives(const Bytes& file, bool verify_checksums) {
  DecodeLimits limits;
  limits.max_faces = 1'000'000;
  limits.max_base_faces = 100'000;
  limits.verify_checksums = verify_checksums;
  StreamDecoder decoder(decode_base, limits);
  const bool fed = decoder.feed(file).ok();
  if (decoder.has_base()) {
    const Status valid = decoder.mesh().connectivity().validate();
    EXPECT_TRUE(valid.ok()) << valid.error().message;
    const int bits = decoder.index().header.lattice.bits;
    for (const Vec3i p : decoder.mesh().positions()) EXPECT_EQ((p.x | p.y | p.z) >> bits, 0);
  }
  return fed;
}

TEST(Corruption, EveryCutIsAnswered) {
  const EncodedShape shape =
      encode_relocating_shape("grid", shapes::bumped(shapes::grid(12, 9), 0.05));
  for (std::size_t n = 0; n <= shape.file.size(); ++n) {
    const Bytes cut(shape.file.begin(), shape.file.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_TRUE(survives(cut, true)) << n;
  }
}

TEST(Corruption, TenThousandFlippedBytesAreAllNoticed) {
  const EncodedShape shape = encode_shape("genus", shapes::bumped(shapes::genus(2), 0.01));
  const std::size_t hash_end = kContentHashOffset + sizeof(ContentHash);
  std::mt19937 random(1);
  for (int round = 0; round < 10'000; ++round) {
    Bytes flipped = shape.file;
    const std::size_t at = random() % flipped.size();
    if (at >= kContentHashOffset && at < hash_end) continue;  // the hash is checked by PmFile
    flipped[at] ^= static_cast<std::uint8_t>(1 + random() % 255);
    StreamDecoder decoder(decode_base);
    EXPECT_TRUE(!decoder.feed(flipped).ok() || !decoder.complete()) << "byte " << at;
  }
}

void flip_past_the_prologue(const Bytes& file) {
  const FileIndex index = **parse_prologue(file);
  std::mt19937 random(2);
  for (int round = 0; round < 2'000; ++round) {
    Bytes flipped = file;
    for (int flips = 1 + static_cast<int>(random() % 3); flips > 0; --flips) {
      const std::size_t body = flipped.size() - index.prologue_bytes;
      flipped[index.prologue_bytes + random() % body] ^= static_cast<std::uint8_t>(random());
    }
    survives(flipped, false);
  }
}

TEST(Corruption, FlippedBytesPastTheChecksumsGiveAnErrorOrAValidMesh) {
  for (const IndexedMesh& mesh : {shapes::bumped(shapes::genus(2), 0.01), shapes::grid_with_ears(8),
                                  shapes::components(30)}) {
    flip_past_the_prologue(encode_shape("shape", mesh).file);
    flip_past_the_prologue(encode_relocating_shape("shape", mesh).file);
  }
  flip_past_the_prologue(file_with_arrivals());
}

TEST(Corruption, FlippedBytesInHeaderAndIndexGiveAnErrorOrAValidMesh) {
  const EncodedShape shape = encode_shape("ball", shapes::icosphere(3));
  const FileIndex index = **parse_prologue(shape.file);
  std::mt19937 random(3);
  for (int round = 0; round < 3'000; ++round) {
    Bytes flipped = shape.file;
    flipped[random() % index.prologue_bytes] ^= static_cast<std::uint8_t>(1 + random() % 255);
    survives(flipped, false);
  }
}

}  // namespace
}  // namespace pmesh
