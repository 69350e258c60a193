// The worked example of docs/pm-format.md.
#include <gtest/gtest.h>

#include "core/pm/split_decoder.h"

namespace pmesh {
namespace {

LatticeMesh two_faces() {
  return {{{0, 100, 0}, {100, 100, 0}, {100, 200, 0}, {0, 200, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

// `chunk` applied to the two faces.
LatticeMesh decode(ByteView chunk, bool has_relocations) {
  FileHeader header;
  header.lattice.bits = 10;
  header.has_borders = true;
  header.has_relocations = has_relocations;
  auto mesh = RefinableMesh::from_base(two_faces());
  EXPECT_TRUE(SplitDecoder(*mesh).decode(chunk, 1, header, *mesh).ok());
  return mesh->snapshot();
}

TEST(Specification, TheExampleAddsAnEar) {
  const Bytes chunk = {0xB8, 0xF9, 0x73, 0x02, 0x2B, 0x80};
  const LatticeMesh mesh = decode(chunk, false);
  EXPECT_EQ(mesh.triangles.back(), (Triangle{4, 1, 0}));
  EXPECT_EQ(mesh.positions.back(), (Vec3i{60, 20, 10}));
}

TEST(Specification, TheExampleWithRelocationsMovesTheKeptVertex) {
  const Bytes chunk = {0xB9, 0x14, 0x29, 0xE7, 0x3C, 0x76, 0x2B, 0x80};
  const LatticeMesh mesh = decode(chunk, true);
  EXPECT_EQ(mesh.triangles.back(), (Triangle{4, 1, 0}));
  EXPECT_EQ(mesh.positions.front(), (Vec3i{0, 102, 0}));
}

}  // namespace
}  // namespace pmesh
