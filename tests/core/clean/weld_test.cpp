#include "tests/core/clean/cleaning.h"

namespace pmesh {
namespace {

TEST(CleanWeld, JoinsASoup) {
  const IndexedMesh sphere = shapes::icosphere(2);
  const CleanedMesh result = cleaned(shapes::soup(sphere), true);
  EXPECT_EQ(result.report.welded, 3 * sphere.triangles.size() - sphere.positions.size());
  EXPECT_EQ(result.mesh.positions.size(), sphere.positions.size());
  EXPECT_EQ(border_edges(result.mesh), 0u);
}

TEST(CleanWeld, JoinsPiecesAtTheirBorders) {
  const IndexedMesh grid = shapes::grid(4, 4);
  const CleanedMesh result = cleaned(shapes::joined(grid, shapes::moved(grid, {1, 0, 0})));
  EXPECT_EQ(result.report.welded, 5u);
  EXPECT_EQ(components(result.mesh), 1u);
  EXPECT_EQ(border_edges(result.mesh), 24u);
}

TEST(CleanWeld, LeavesInteriorVerticesApart) {
  IndexedMesh sphere = shapes::icosphere(1);
  for (Vec3d& p : sphere.positions) p = {};
  const CleanedMesh result = cleaned(sphere);
  EXPECT_EQ(result.report.welded, 0u);
  EXPECT_EQ(result.mesh.triangles, sphere.triangles);
}

TEST(CleanWeld, TakesMinusZeroForZero) {
  const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {0, -1, 0}, {1, 0, 0}},
                         {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(cleaned(mesh).report.welded, 2u);
  EXPECT_EQ(components(cleaned(mesh).mesh), 1u);
}

TEST(CleanWeld, ComparesPositionsExactly) {
  const double above_one = std::nextafter(1.0, 2.0);
  const IndexedMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, -1, 0}, {above_one, 0, 0}},
      {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(cleaned(mesh).report.welded, 1u);
}

TEST(CleanWeld, TheLowestVertexSurvives) {
  const IndexedMesh grid = shapes::grid(3, 3);
  const IndexedMesh soup = shapes::soup(grid);
  std::vector<Vec3d> in_order_of_appearance;
  for (const Vec3d& p : soup.positions) {
    if (std::find(in_order_of_appearance.begin(), in_order_of_appearance.end(), p) ==
        in_order_of_appearance.end()) {
      in_order_of_appearance.push_back(p);
    }
  }
  EXPECT_EQ(cleaned(soup, true).mesh.positions, in_order_of_appearance);
}

TEST(CleanWeld, DropsFacesThatItMakesDegenerate) {
  const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 1, 2}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.welded, 1u);
  EXPECT_EQ(result.report.degenerate, 1u);
  EXPECT_EQ(result.report.unreferenced, 2u);
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_TRUE(result.mesh.positions.empty());
}

TEST(CleanWeld, ADuplicateFaceDoesNotHideABorder) {
  const IndexedMesh grid = shapes::grid(1, 1);
  IndexedMesh mesh = shapes::joined(grid, shapes::moved(grid, {1, 0, 0}));
  mesh.triangles.push_back(mesh.triangles[0]);
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.welded, 2u);
  EXPECT_EQ(components(result.mesh), 1u);
}

}  // namespace
}  // namespace pmesh
