// MELOD's equations on configurations worked out by hand.
#include "core/metrics/melod.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/decimate/rings.h"

namespace pmesh {
namespace {

const double kRoot3 = std::sqrt(3.0);

double cost(const Melod& melod, const IndexedMesh& mesh, std::uint32_t v, std::uint32_t head) {
  const OneRing ring = ring_of(mesh, v);
  return melod.cost(ring, melod.prepare(ring), index_in(ring, head), moved_to(ring, head));
}

TEST(Melod, FlatVertexHasNoImportance) {
  EXPECT_DOUBLE_EQ(Melod::importance(ring_of(square(), 4)), 0);
}

TEST(Melod, FlatBorderVertexHasNoImportance) {
  EXPECT_DOUBLE_EQ(Melod::importance(ring_of(square(), 0)), 0);
}

TEST(Melod, CubeCornerIsImportant) {
  // Three equal faces with the axes as normals: k = (1, 1, 1) / 3.
  EXPECT_NEAR(Melod::importance(ring_of(cube_corner(), 0)), 1 - 1 / kRoot3, 1e-15);
}

TEST(Melod, ImportanceWeighsNormalsByArea) {
  // The faces' normals are -y, -x and -z, their areas now 1, 1/2 and 1.
  IndexedMesh mesh = cube_corner();
  mesh.positions[1].x = 2;
  EXPECT_NEAR(Melod::importance(ring_of(mesh, 0)), 1 - std::sqrt(1 + 0.25 + 1) / 2.5, 1e-15);
}

TEST(Melod, StarWithoutAreaHasNoImportance) {
  IndexedMesh mesh = cube_corner();
  for (Vec3d& p : mesh.positions) p = {1, 2, 3};
  EXPECT_EQ(Melod::importance(ring_of(mesh, 0)), 0);
}

TEST(Melod, CostOfACubeCornerIsThatOfItsOneMovedFace) {
  // Face (0, 3, 2), area 1/2, normal -x, becomes (1, 3, 2), area sqrt(3)/2, normal -(1, 1, 1).
  const double expected = 0.5 * (0.5 + kRoot3 / 2) * (1 - 1 / kRoot3);
  EXPECT_NEAR(cost(Melod(), cube_corner(), 0, 1), expected, 1e-15);
}

TEST(Melod, MovingInAPlaneCostsNothing) { EXPECT_NEAR(cost(Melod(), square(), 4, 0), 0, 1e-15); }

TEST(Melod, FaceThatLosesItsAreaCostsHalfOfIt) {
  // With vertex 1 on the line through 2 and 3, face (0, 3, 2) becomes flat: 0.5 (1/2 + 0) (1 - 0).
  IndexedMesh mesh = cube_corner();
  mesh.positions[1] = {0, 0.5, 0.5};
  EXPECT_NEAR(cost(Melod(), mesh, 0, 1), 0.25, 1e-15);
}

// A strip whose border goes straight on from 0 over 1 to 2; 3 lies above 1.
IndexedMesh strip() {
  return {{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 1, 0}}, {{0, 1, 3}, {1, 2, 3}}};
}

TEST(Melod, BorderTurnIsTwoAlongAStraightBorder) {
  const OneRing ring = ring_of(strip(), 0);
  EXPECT_DOUBLE_EQ(Melod::border_turn(ring, index_in(ring, 1)), 2);
}

TEST(Melod, BorderTurnIsOneAtARightAngleInBothDirections) {
  const OneRing ring = ring_of(square(), 0);
  EXPECT_DOUBLE_EQ(Melod::border_turn(ring, index_in(ring, 1)), 1);
  EXPECT_DOUBLE_EQ(Melod::border_turn(ring, index_in(ring, 3)), 1);
}

TEST(Melod, BorderCollapseCostsLambdaTimesTurnTimesLength) {
  IndexedMesh mesh = strip();
  for (Vec3d& p : mesh.positions) p = 3.0 * p;
  EXPECT_DOUBLE_EQ(cost(Melod(), mesh, 0, 1), 10 * 2 * 3);
  EXPECT_DOUBLE_EQ(cost(Melod(50), mesh, 0, 1), 50 * 2 * 3);
}

TEST(Melod, PriorityScalesTheGreaterOfCostAndPoppedKey) {
  const OneRing ring = ring_of(cube_corner(), 0);
  const double w = Melod::importance(ring);
  EXPECT_DOUBLE_EQ(Melod().priority({w}, 2, 0.5), w * 2);
  EXPECT_DOUBLE_EQ(Melod().priority({w}, 2, 7), w * 7);
}

}  // namespace
}  // namespace pmesh
