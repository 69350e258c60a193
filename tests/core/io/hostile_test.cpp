// Input that is cut, altered or lies: every answer is an error or a sound mesh.
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "core/io/import.h"
#include "tests/core/io/samples.h"

namespace pmesh {
namespace {

// Parses a block of exactly this size, so that AddressSanitizer sees a read one byte too far.
Result<ImportedMesh> parse_block(MeshFormat format, std::string_view bytes) {
  const auto block = std::make_unique<std::uint8_t[]>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), block.get());
  return parse_mesh(format, {block.get(), bytes.size()});
}

void expect_sound(const Result<ImportedMesh>& result) {
  if (!result.ok()) {
    EXPECT_FALSE(result.error().message.empty());
    return;
  }
  const IndexedMesh& mesh = result->mesh;
  EXPECT_FALSE(mesh.triangles.empty());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) EXPECT_LT(corner, mesh.positions.size());
  }
}

TEST(HostileMesh, EveryTruncationIsAnErrorOrASoundMesh) {
  for (const Sample& sample : samples()) {
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      SCOPED_TRACE(sample.name + (" cut at " + std::to_string(size)));
      expect_sound(parse_block(sample.format, std::string_view(sample.bytes).substr(0, size)));
    }
  }
}

TEST(HostileMesh, TruncationsOfCountedFormatsAreErrors) {
  for (const Sample& sample : samples()) {
    if (sample.format == MeshFormat::obj) continue;
    for (std::size_t size = 0; size + 3 < sample.bytes.size(); ++size) {
      const auto cut = parse_block(sample.format, std::string_view(sample.bytes).substr(0, size));
      EXPECT_FALSE(cut.ok()) << sample.name << " cut at " << size;
    }
  }
}

TEST(HostileMesh, EveryAlteredByteIsAnErrorOrASoundMesh) {
  std::mt19937 random(1);
  for (const Sample& sample : samples()) {
    for (int i = 0; i < 5000; ++i) {
      std::string bytes = sample.bytes;
      for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips) {
        bytes[random() % bytes.size()] = static_cast<char>(random());
      }
      SCOPED_TRACE(sample.name + (" alteration " + std::to_string(i)));
      expect_sound(parse_block(sample.format, bytes));
    }
  }
}

TEST(HostileMesh, AFormatTakenForAnotherIsAnErrorOrASoundMesh) {
  for (const Sample& sample : samples()) {
    for (const MeshFormat format :
         {MeshFormat::ply, MeshFormat::obj, MeshFormat::stl, MeshFormat::off}) {
      expect_sound(parse_block(format, sample.bytes));
    }
  }
}

TEST(HostileMesh, CountsBeyondTheFileTakeNoMemory) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    for (const char* count : {"4000000000", "1000000000000000000", "9223372036854775807"}) {
      EXPECT_FALSE(parse_block(MeshFormat::ply, std::string("ply\nformat ") + format +
                                                    " 1.0\nelement vertex " + count + "\n" + xyz)
                       .ok());
    }
  }
  for (const char* counts : {"4000000000 1 0", "1 4000000000 0", "9223372036854775807 1"}) {
    EXPECT_FALSE(parse_block(MeshFormat::off, std::string("OFF\n") + counts + "\n0 0 0\n").ok());
  }
}

TEST(HostileMesh, ALongContinuedLineTakesLinearTime) {
  std::string bytes = "v 0 0 0\nf ";
  for (int i = 0; i < 500'000; ++i) bytes += "1 \\\n";
  const Result<ImportedMesh> result = parse_block(MeshFormat::obj, bytes);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->mesh.triangles.size(), 499'998u);
}

}  // namespace
}  // namespace pmesh
