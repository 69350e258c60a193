#include "tests/core/clean/cleaning.h"

namespace pmesh {
namespace {

TEST(CleanRepeats, DropsDegenerateAndDuplicateFaces) {
  const CleanedMesh result = cleaned(shapes::repeats());
  EXPECT_EQ(result.report.degenerate, 1u);
  EXPECT_EQ(result.report.duplicate, 2u);
  EXPECT_EQ(result.mesh.triangles, shapes::tetrahedron().triangles);
}

TEST(CleanRepeats, FindsDuplicatesInAnyRotation) {
  const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                         {{2, 0, 1}, {0, 1, 2}, {1, 2, 0}, {2, 0, 1}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.duplicate, 3u);
  EXPECT_EQ(result.mesh.triangles, (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(CleanRepeats, KeepsBothOrientationsOnce) {
  const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                         {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {2, 1, 0}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.duplicate, 2u);
  EXPECT_EQ(result.report.opposite_pairs, 1u);
}

TEST(CleanRepeats, KeepsFacesOfZeroAreaWithDistinctVertices) {
  const IndexedMesh mesh = shapes::lattice_degenerate(20);
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.mesh.triangles, mesh.triangles);
  EXPECT_EQ(result.mesh.positions, mesh.positions);
}

TEST(CleanRepeats, DropsUnusedVerticesAndKeepsTheOrder) {
  IndexedMesh mesh{{{9, 9, 9}, {0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}}, {{4, 1, 3}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.unreferenced, 2u);
  EXPECT_EQ(result.report.welded, 0u);
  EXPECT_EQ(result.mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(result.mesh.triangles, (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(CleanRepeats, MayLeaveNothing) {
  EXPECT_TRUE(cleaned({}).mesh.triangles.empty());
  const CleanedMesh result = cleaned({{{0, 0, 0}}, {{0, 0, 0}}});
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_TRUE(result.mesh.positions.empty());
}

}  // namespace
}  // namespace pmesh
