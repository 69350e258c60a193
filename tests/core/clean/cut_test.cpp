// What clean() cuts, what it leaves together, and what it counts.
#include "tests/core/clean/cleaning.h"

namespace pmesh {
namespace {

std::vector<Vec3d> any_positions(int count) {
  std::vector<Vec3d> positions;
  for (int k = 0; k < count; ++k) positions.push_back({double(k), double(k * k), 0.5 * k});
  return positions;
}

TEST(CleanCut, LeavesManifoldsUntouched) {
  for (const auto& [name, mesh] : shapes::manifolds()) {
    const CleanedMesh result = cleaned(mesh);
    EXPECT_EQ(result.mesh.triangles, mesh.triangles) << name;
    EXPECT_EQ(result.mesh.positions, mesh.positions) << name;
    EXPECT_EQ(result.report.vertices_added, 0u) << name;
  }
}

TEST(CleanCut, CutsAnEdgeOfThreeFaces) {
  const CleanedMesh result = cleaned(shapes::fan_edge(3));
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 1u);
  EXPECT_EQ(result.report.nonmanifold_vertices_cut, 0u);
  EXPECT_EQ(result.report.vertices_added, 4u);
  EXPECT_EQ(components(result.mesh), 3u);
}

TEST(CleanCut, CutsAnEdgeOfManyFaces) {
  const CleanedMesh result = cleaned(shapes::fan_edge(2000));
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 1u);
  EXPECT_EQ(result.report.vertices_added, 2 * 1999u);
  EXPECT_EQ(components(result.mesh), 2000u);
}

TEST(CleanCut, ManyFacesOnOneSideAreNoWindingEdge) {
  const IndexedMesh mesh{any_positions(5), {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 1u);
  EXPECT_EQ(result.report.winding_edges_cut, 0u);
}

TEST(CleanCut, CutsAnEdgeOfDisagreeingFaces) {
  const CleanedMesh result = cleaned({any_positions(4), {{0, 1, 2}, {0, 1, 3}}});
  EXPECT_EQ(result.report.winding_edges_cut, 1u);
  EXPECT_EQ(result.report.nonmanifold_vertices_cut, 0u);
  EXPECT_EQ(components(result.mesh), 2u);
}

TEST(CleanCut, OpensAMoebiusStripOnce) {
  const IndexedMesh strip = shapes::moebius(12);
  const CleanedMesh result = cleaned(strip);
  EXPECT_EQ(result.report.winding_edges_cut, 1u);
  EXPECT_EQ(result.report.vertices_added, 2u);
  EXPECT_EQ(components(result.mesh), 1u);
}

TEST(CleanCut, CutsABowTie) {
  const CleanedMesh result = cleaned(shapes::bow_tie());
  EXPECT_EQ(result.report.nonmanifold_vertices_cut, 1u);
  EXPECT_EQ(result.report.vertices_added, 1u);
  EXPECT_EQ(components(result.mesh), 2u);
}

TEST(CleanCut, CountsABowTieOfManyFansOnce) {
  IndexedMesh mesh{any_positions(41), {}};
  for (std::uint32_t v = 1; v < 41; v += 2) mesh.triangles.push_back({0, v, v + 1});
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.nonmanifold_vertices_cut, 1u);
  EXPECT_EQ(result.report.vertices_added, 19u);
}

TEST(CleanCut, TheFirstFanKeepsTheVertex) {
  const CleanedMesh result = cleaned(shapes::bow_tie());
  EXPECT_EQ(result.mesh.triangles[0][0], 0u);
  EXPECT_EQ(result.mesh.triangles[3][0], 9u);
  EXPECT_EQ(result.mesh.positions[9], result.mesh.positions[0]);
}

TEST(CleanCut, SolidsThatTouchInAnEdgeStayClosed) {
  const CleanedMesh result = cleaned(shapes::cubes_sharing_an_edge());
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 1u);
  EXPECT_EQ(components(result.mesh), 2u);
  EXPECT_EQ(border_edges(result.mesh), 0u);
}

TEST(CleanOppositePairs, ALonePairBecomesTwoTriangles) {
  const CleanedMesh result = cleaned({any_positions(3), {{0, 1, 2}, {0, 2, 1}}});
  EXPECT_EQ(result.report.opposite_pairs, 1u);
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 0u);
  EXPECT_EQ(result.report.nonmanifold_vertices_cut, 0u);
  EXPECT_EQ(result.report.vertices_added, 3u);
  EXPECT_EQ(components(result.mesh), 2u);
}

TEST(CleanOppositePairs, TwoSidedSurfacesBecomeTwoSurfaces) {
  IndexedMesh mesh = shapes::icosphere(1);
  const std::vector<Triangle> outside = mesh.triangles;
  for (const auto [a, b, c] : outside) mesh.triangles.push_back({c, b, a});
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.opposite_pairs, outside.size());
  EXPECT_EQ(result.report.vertices_added, mesh.positions.size());
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 0u);
  EXPECT_EQ(components(result.mesh), 2u);
  EXPECT_EQ(border_edges(result.mesh), 0u);
}

TEST(CleanOppositePairs, EachNeighbourGoesOnWithTheCopyThatAgrees) {
  // A square's two triangles, and the back side of the first one.
  const IndexedMesh mesh{any_positions(4), {{0, 1, 2}, {0, 2, 1}, {0, 2, 3}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.opposite_pairs, 1u);
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 0u);
  EXPECT_EQ(components(result.mesh), 2u);
  EXPECT_EQ(result.mesh.triangles[2][0], result.mesh.triangles[0][0]);
  EXPECT_EQ(result.mesh.triangles[2][1], result.mesh.triangles[0][2]);
}

TEST(CleanOppositePairs, APartlyTwoSidedSurfaceKeepsItsFrontWhole) {
  const CleanedMesh result = cleaned(shapes::opposite_sheets(8));
  EXPECT_EQ(result.report.opposite_pairs, 64u);
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 0u);
  EXPECT_EQ(result.report.vertices_added, 5 * 9u);
  EXPECT_EQ(components(result.mesh), 2u);
  EXPECT_EQ(border_edges(result.mesh), 32u + 24u);
}

TEST(CleanOppositePairs, APairBetweenTwoOtherFacesIsCut) {
  // Which of the two goes on with which copy is ambiguous.
  const IndexedMesh mesh{any_positions(5), {{0, 1, 2}, {0, 2, 1}, {0, 1, 3}, {1, 0, 4}}};
  const CleanedMesh result = cleaned(mesh);
  EXPECT_EQ(result.report.opposite_pairs, 1u);
  EXPECT_EQ(result.report.nonmanifold_edges_cut, 1u);
  EXPECT_EQ(components(result.mesh), 4u);
}

}  // namespace
}  // namespace pmesh
