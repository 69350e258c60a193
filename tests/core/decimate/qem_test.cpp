#include "core/metrics/qem.h"

#include <gtest/gtest.h>

#include "core/decimate/edge_star.h"
#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

constexpr MetricFrame kOwnUnits{};

QuadricField field_of(const IndexedMesh& mesh) {
  QuadricField field;
  field.start(half_edges(mesh), mesh.positions, kOwnUnits);
  return field;
}

TEST(Quadric, OfAPlaneIsTheWeightedSquaredDistance) {
  const Quadric q = Quadric::plane({0, 0, 1}, -2, 3);
  EXPECT_DOUBLE_EQ(q({5, -7, 2}), 0);
  EXPECT_DOUBLE_EQ(q({1, 1, 4}), 3 * 4);
}

TEST(Quadric, KeepsItsValuesWhenTheOriginMoves) {
  const Quadric q = Quadric::plane({0.6, 0, 0.8}, -2, 3) + Quadric::plane({0, 1, 0}, 1, 0.5);
  const Vec3d origin{1, -2, 3}, p{0.5, 0.25, -1};
  EXPECT_NEAR(q.relative_to(origin)(p), q(origin + p), 1e-12);
}

TEST(Quadric, LeastOfThreePlanesIsTheirCommonPoint) {
  const Quadric q = Quadric::plane({1, 0, 0}, -1, 1) + Quadric::plane({0, 1, 0}, -2, 2) +
                    Quadric::plane({0, 0, 1}, -3, 4);
  EXPECT_LT(length(q.least(0) - Vec3d{1, 2, 3}), 1e-12);
}

TEST(Quadric, LeastIsNearTheOriginWhereDirectionsAreOpen) {
  const Quadric plane = Quadric::plane({0, 0, 1}, -3, 1);
  EXPECT_LT(length(plane.least(1e-6) - Vec3d{0, 0, 3}), 1e-5);
  EXPECT_EQ(Quadric().least(1e-6), Vec3d());
}

TEST(Quadric, SquaredAreaIsThatOfTheTriangle) {
  const Quadric q = Quadric::squared_area({0, 0, 0}, {2, 0, 0});
  EXPECT_DOUBLE_EQ(q({1, 3, 0}), 9);
  EXPECT_DOUBLE_EQ(q({7, 0, 4}), 16);
  EXPECT_DOUBLE_EQ(q({-5, 0, 0}), 0);
}

TEST(Qem, AVertexIsAtTheLeastOfItsOwnPlanes) {
  EXPECT_NEAR(field_of(cube_corner())[VertexId(0)]({0, 0, 0}), 0, 1e-15);
}

TEST(Qem, OffACubeCornerEveryFaceCountsByItsArea) {
  // Three faces of area 1/2 meet in vertex 0, which lies on no border.
  EXPECT_NEAR(field_of(cube_corner())[VertexId(0)]({0, 0, 2}), 0.5 * 4, 1e-15);
}

TEST(Qem, BordersAreHeldInTheirPlane) {
  const QuadricField field = field_of(square());
  EXPECT_NEAR(field[VertexId(4)]({9, 9, 0}), 0, 1e-12);
  EXPECT_GT(field[VertexId(0)]({0.1, 0.1, 0}), 1);
}

TEST(Qem, CollapseInAPlaneCostsNothing) {
  QemSubset qem;
  const IndexedMesh mesh = square();
  qem.start(half_edges(mesh), mesh.positions, kOwnUnits);
  OneRing ring = ring_of(mesh, 4);
  ring.origin = mesh.positions[4];
  // Into a border vertex, whose border planes it does not leave.
  EXPECT_NEAR(qem.cost(ring, qem.prepare(ring), index_in(ring, 0), {}), 0, 1e-12);
}

TEST(Qem, FoldAddsUpQuadrics) {
  QuadricField field = field_of(cube_corner());
  const double before = field[VertexId(0)]({1, 2, 3}) + field[VertexId(1)]({1, 2, 3});
  field.fold(VertexId(0), VertexId(1));
  EXPECT_NEAR(field[VertexId(1)]({1, 2, 3}), before, 1e-9 * before);
}

TEST(Qem, SolvedPlacementOfAFlatEdgeIsItsMiddle) {
  const IndexedMesh mesh = shapes::grid(6, 6);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  QemSolved qem;
  qem.start(work.mesh(), work.positions(), work.frame());
  const VertexId inner(3 * 7 + 3);
  EdgeStar star;
  gather_ends(work, work.mesh().find_edge(inner, VertexId(inner.value + 1)), star);
  const Placement placement = qem.place(star);
  EXPECT_NEAR(placement.cost, 0, 1e-15);
  EXPECT_LT(length(placement.position), 1e-9);
}

}  // namespace
}  // namespace pmesh
