// Hostile chunks, where no checksum stands in the way: each gives an error or a valid mesh on the
// lattice that goes back to its base, and never takes long. Under ASan and UBSan these tests are
// the proof that no byte is trusted.
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "core/pm/split_decoder.h"
#include "tests/fixtures/random_chunks.h"

namespace pmesh {
namespace {

void expect_sound(RefinableMesh& mesh, const SplitBase& base) {
  const Status valid = mesh.connectivity().validate();
  EXPECT_TRUE(valid.ok()) << base.name << ": " << valid.error().message;
  for (const Vec3i p : mesh.positions()) {
    ASSERT_EQ((p.x | p.y | p.z) >> base.header.lattice.bits, 0) << base.name;
  }
  mesh.set_steps(0);
  EXPECT_EQ(mesh.snapshot().positions, base.mesh.positions) << base.name;
  EXPECT_EQ(mesh.snapshot().triangles, base.mesh.triangles) << base.name;
}

// Decodes `bytes` from a block of exactly their size. True if no error came of it.
bool survives(const SplitBase& base, ByteView bytes, std::uint32_t splits) {
  const auto block = std::make_unique<std::uint8_t[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), block.get());
  RefinableMesh mesh = base.refinable();
  const bool decoded =
      SplitDecoder(mesh).decode({block.get(), bytes.size()}, splits, base.header, mesh).ok();
  expect_sound(mesh, base);
  return decoded;
}

// Batches that sweep, go on, and name their vertices, in a few hundred bytes.
RandomChunks::Chunk small_chunk(const SplitBase& base) {
  RandomChunks chunks(base, 1);
  chunks.add_batch(std::min(30u, base.refinable().vertex_count()));
  for (int k = 0; k < 3; ++k) chunks.add_batch(2);
  return chunks.finish_chunk();
}

TEST(SplitCorruption, EveryCutIsAnErrorOrAValidMesh) {
  for (const SplitBase& base : split_bases()) {
    const auto [bytes, splits] = small_chunk(base);
    ASSERT_TRUE(survives(base, bytes, splits)) << base.name;
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      survives(base, ByteView(bytes).first(n), splits);
      survives(base, ByteView(bytes).last(n), splits);
    }
  }
}

TEST(SplitCorruption, ThousandsOfFlippedBytesGiveAnErrorOrAValidMesh) {
  std::mt19937 random(1);
  for (const SplitBase& base : split_bases()) {
    const auto [bytes, splits] = small_chunk(base);
    for (int round = 0; round < 1'000; ++round) {
      Bytes flipped = bytes;
      for (std::uint32_t flips = 1 + static_cast<std::uint32_t>(random() % 3); flips > 0; --flips) {
        flipped[random() % flipped.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
      }
      survives(base, flipped, splits);
    }
  }
}

TEST(SplitCorruption, NoiseGivesAnErrorOrAValidMesh) {
  std::mt19937 random(2);
  for (const SplitBase& base : split_bases()) {
    for (int round = 0; round < 500; ++round) {
      Bytes noise(1 + random() % 300);
      const std::uint32_t likely = random() % 256;
      for (auto& byte : noise) {
        byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : likely);
      }
      survives(base, noise, 1 + static_cast<std::uint32_t>(random() % (8 * noise.size())));
    }
  }
}

// A header that denies what the mesh has.
TEST(SplitCorruption, SplitsOfBordersThatTheHeaderDeniesGiveAnErrorOrAValidMesh) {
  std::mt19937 random(3);
  for (SplitBase base : split_bases()) {
    const auto [bytes, splits] = small_chunk(base);
    base.header.has_borders = false;
    for (int round = 0; round < 200; ++round) {
      Bytes flipped = bytes;
      flipped[random() % flipped.size()] ^= static_cast<std::uint8_t>(random());
      survives(base, flipped, splits);
    }
  }
}

}  // namespace
}  // namespace pmesh
