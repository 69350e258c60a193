#include "core/measure/sampling.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/measure/unit_surface.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using Over = SurfaceSampler::Over;

std::vector<Vec3d> points_of(const Surface& surface, Over over, std::uint32_t count,
                             std::uint64_t seed = 0) {
  const SurfaceSampler sampler(surface, over, count, seed);
  std::vector<Vec3d> points;
  sampler.visit(0, sampler.count(),
                [&](const SamplePoint& s) { points.push_back(s.on(surface.corners(s.face))); });
  return points;
}

// Two faces, one three times as large as the other, in the plane z = 0.
IndexedMesh large_and_small() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(Sampling, GivesEachFaceItsShareOfTheArea) {
  const std::vector<Vec3d> points = points_of(unit_surface(large_and_small()), Over::faces, 4000);
  const auto in_small =
      std::count_if(points.begin(), points.end(), [](Vec3d p) { return p.x > 0; });
  EXPECT_NEAR(static_cast<double>(in_small), 1000, 1);
}

TEST(Sampling, SpreadsEvenlyWithinAFace) {
  const IndexedMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  Vec3d sum;
  for (const Vec3d p : points_of(unit_surface(one), Over::faces, 40'000)) {
    EXPECT_TRUE(p.x >= 0 && p.y >= 0 && p.x + p.y <= 1 + 1e-15 && p.z == 0);
    sum += Vec3d{p.x, p.y, p.x * p.y};
  }
  EXPECT_NEAR(sum.x / 40'000, 1.0 / 3, 0.005);
  EXPECT_NEAR(sum.y / 40'000, 1.0 / 3, 0.005);
  EXPECT_NEAR(sum.z / 40'000, 1.0 / 12, 0.002);
}

TEST(Sampling, SpreadsEvenlyAlongEdges) {
  const IndexedMesh one{{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}};
  int bottom = 0, left = 0;
  for (const Vec3d p : points_of(unit_surface(one), Over::edges, 12'000)) {
    EXPECT_NEAR(std::min({p.x, p.y, (12 - 3 * p.x - 4 * p.y) / 5}), 0, 1e-12);
    bottom += p.y == 0;
    left += p.x == 0;
  }
  EXPECT_NEAR(bottom, 4000, 200);
  EXPECT_NEAR(left, 3000, 200);
}

TEST(Sampling, DependsOnTheSeedAlone) {
  const Surface surface = unit_surface(shapes::icosphere(2));
  EXPECT_EQ(points_of(surface, Over::faces, 500, 3), points_of(surface, Over::faces, 500, 3));
  EXPECT_NE(points_of(surface, Over::faces, 500, 3), points_of(surface, Over::faces, 500, 4));
}

TEST(Sampling, GivesTheSameSamplesInParts) {
  const Surface surface = unit_surface(shapes::lattice_degenerate(12));
  const SurfaceSampler sampler(surface, Over::faces, 1000, 5);
  std::vector<std::uint32_t> whole, parts;
  sampler.visit(0, 1000, [&](const SamplePoint& s) { whole.push_back(s.face); });
  for (std::uint32_t begin = 0; begin < 1000; begin += 100) {
    sampler.visit(begin, begin + 100, [&](const SamplePoint& s) { parts.push_back(s.face); });
  }
  EXPECT_EQ(whole, parts);
}

TEST(Sampling, SkipsCollapsedFacesAndUnusedVertices) {
  IndexedMesh mesh = large_and_small();
  mesh.positions.insert(mesh.positions.end(), {{9, 9, 9}, {9, 9, 9}, {8, 8, 8}});
  mesh.triangles.push_back({4, 5, 0});
  const Surface surface = unit_surface(mesh);
  for (const Over over : {Over::faces, Over::edges}) {
    for (const Vec3d p : points_of(surface, over, 1000)) EXPECT_EQ(p.z, 0);
  }
  std::vector<std::uint32_t> vertices = measured_vertices(surface);
  std::sort(vertices.begin(), vertices.end());
  EXPECT_EQ(vertices, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(Sampling, GivesNothingWhereThereIsNoArea) {
  const IndexedMesh line{{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {{0, 1, 2}}};
  EXPECT_TRUE(points_of(unit_surface(line), Over::faces, 10).empty());
  EXPECT_EQ(points_of(unit_surface(line), Over::edges, 10).size(), 10u);
}

}  // namespace
}  // namespace pmesh
