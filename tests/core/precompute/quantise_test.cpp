#include "core/precompute/quantise.h"

#include <gtest/gtest.h>

#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

LatticeMesh triangle() { return {{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}, {{0, 1, 2}}}; }

TEST(SameTriangles, IgnoresNumberingAndWhereATriangleStarts) {
  const LatticeMesh renumbered{{{0, 5, 0}, {0, 0, 0}, {5, 0, 0}}, {{2, 0, 1}}};
  EXPECT_TRUE(same_triangles(triangle(), renumbered));
}

TEST(SameTriangles, SeesOrientationPositionAndCount) {
  LatticeMesh flipped = triangle(), moved = triangle(), doubled = triangle();
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  moved.positions[1].z = 1;
  doubled.triangles.push_back({1, 2, 0});
  EXPECT_FALSE(same_triangles(triangle(), flipped));
  EXPECT_FALSE(same_triangles(triangle(), moved));
  EXPECT_FALSE(same_triangles(triangle(), doubled));
}

TEST(ChooseLattice, TakesTheBitsAskedFor) {
  const auto lattice = choose_lattice(shapes::icosphere(3), shapes::icosphere(3).positions,
                                      {.bits = 11, .tolerance = {}});
  ASSERT_TRUE(lattice.ok());
  EXPECT_EQ(lattice->bits, 11);
}

TEST(ChooseLattice, TakesTheToleranceAskedFor) {
  const auto lattice = choose_lattice(shapes::icosphere(3), shapes::icosphere(3).positions,
                                      {.bits = {}, .tolerance = 0.01});
  ASSERT_TRUE(lattice.ok());
  EXPECT_EQ(lattice->step, 0.02);
}

TEST(ChooseLattice, RefusesMoreBitsThanDoublesCanTellApart) {
  const IndexedMesh far = shapes::moved(shapes::icosphere(2), {1e15, 0, 0});
  EXPECT_FALSE(choose_lattice(far, far.positions, {.bits = 20, .tolerance = {}}).ok());
}

TEST(ChooseLattice, ByItselfStaysWithinWhatDoublesCanTellApart) {
  const IndexedMesh far = shapes::moved(shapes::icosphere(2), {1e15, 0, 0});
  const auto lattice = choose_lattice(far, far.positions, {});
  ASSERT_TRUE(lattice.ok()) << lattice.error().message;
  EXPECT_GE(lattice->step, 0.125);
}

TEST(ChooseLattice, KeepsAMeshFarFromTheOrigin) {
  const IndexedMesh near = shapes::icosphere(4);
  const IndexedMesh far = shapes::moved(near, {5e6, 5e6, 0});
  const auto lattice = choose_lattice(far, far.positions, {});
  ASSERT_TRUE(lattice.ok());
  const std::vector<Vec3i> points = quantise(far.positions, *lattice);
  for (std::size_t v = 0; v < points.size(); ++v) {
    EXPECT_LE(length(lattice->position(points[v]) - far.positions[v]), lattice->step);
  }
}

}  // namespace
}  // namespace pmesh
