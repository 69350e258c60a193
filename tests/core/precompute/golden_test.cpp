// Files that every later version must write, and decode, to the same digests. A change of format
// or of the decimation order changes them on purpose: then they are made anew, in the same commit,
// with PMESH_WRITE_GOLDEN=1.
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fixtures/mesh_digest.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

const std::string kDirectory = PMESH_GOLDEN_DIRECTORY;

struct Golden {
  EncodedShape shape;
  std::uint32_t decoded_digest;  // of positions, then triangles, at full resolution
};

// Shapes without transcendental functions, whose coordinates are the same on every machine.
std::vector<Golden> goldens() {
  return {{encode_shape("tetrahedron", shapes::tetrahedron()), 1162967856u},
          {encode_shape("genus3", shapes::genus(3)), 2406500258u},
          {encode_shape("ears", shapes::grid_with_ears(12)), 1535212025u},
          {encode_shape("sphere", shapes::icosphere(4)), 1354794680u},
          {encode_relocating_shape("relocations", shapes::grid_with_ears(8)), 1584331689u},
          {{"arrivals", file_with_arrivals(), {}, {}}, 4142437826u}};
}

Bytes read_golden(const std::string& name) {
  std::ifstream file(kDirectory + "/" + name + ".pmesh", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(Golden, TheEncoderStillWritesTheSameFiles) {
  for (const auto& [shape, _] : goldens()) {
    if (std::getenv("PMESH_WRITE_GOLDEN") != nullptr) {
      std::ofstream file(kDirectory + "/" + shape.name + ".pmesh", std::ios::binary);
      file.write(reinterpret_cast<const char*>(shape.file.data()),
                 static_cast<std::streamsize>(shape.file.size()));
    }
    EXPECT_EQ(shape.file, read_golden(shape.name)) << shape.name;
  }
}

TEST(Golden, TheDecoderStillGivesTheSameMeshes) {
  for (const auto& [shape, decoded_digest] : goldens()) {
    StreamDecoder decoder(decode_base);
    ASSERT_TRUE(decoder.feed(read_golden(shape.name)).ok()) << shape.name;
    EXPECT_EQ(digest(decoder.mesh().snapshot()), decoded_digest) << shape.name;
  }
}

}  // namespace
}  // namespace pmesh
