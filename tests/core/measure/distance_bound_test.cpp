#include "core/measure/distance_bound.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/measure/sampled_distance.h"
#include "tests/core/measure/unit_surface.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

constexpr double kTolerance = 0.1;

struct Bounds {
  double reached, bound;
};

Bounds bounds_of(const IndexedMesh& from, const IndexedMesh& to, unsigned threads = 1) {
  const Surface source = unit_surface(from), target = unit_surface(to);
  DistanceBound distance(source, target, kTolerance, threads);
  distance.find();
  return {distance.reached(), distance.bound()};
}

// Largest over so many points that little is missed.
double sampled_maximum(const IndexedMesh& from, const IndexedMesh& to) {
  const Surface source = unit_surface(from), target = unit_surface(to);
  const SurfaceSampler points(source, SurfaceSampler::Over::faces, 100'000, 9);
  return std::max(sampled_distance(source, points, target, 2).max,
                  vertex_distance(source, target, 2).max);
}

void expect_sharp(const std::string& name, const IndexedMesh& from, const IndexedMesh& to) {
  const Bounds bounds = bounds_of(from, to);
  const double sampled = sampled_maximum(from, to);
  EXPECT_GE(bounds.bound + kNoDistance, sampled) << name;
  EXPECT_GE(bounds.reached * (1 + kTolerance), sampled) << name;
  EXPECT_LE(bounds.reached, bounds.bound + 1e-15) << name;
  EXPECT_LE(bounds.bound, bounds.reached * (1 + kTolerance) + kNoDistance) << name;
}

TEST(DistanceBound, IsSharpForEveryShape) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    const IndexedMesh moved = shapes::bumped(shape.mesh, 0.05);
    expect_sharp(shape.name, shape.mesh, moved);
    expect_sharp(shape.name + ", back", moved, shape.mesh);
  }
}

TEST(DistanceBound, IsSharpBetweenDifferentMeshesOfASurface) {
  expect_sharp("spheres", shapes::icosphere(2), shapes::icosphere(4));
  expect_sharp("back", shapes::icosphere(4), shapes::icosphere(2));
  expect_sharp("tori", shapes::torus(40, 15), shapes::torus(13, 22));
}

TEST(DistanceBound, IsSharpBetweenSurfacesFarApart) {
  expect_sharp("apart", shapes::genus(2), shapes::moved(shapes::icosphere(2), {3, 1, 0}));
}

IndexedMesh random_soup(std::mt19937& random, int faces, double size) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Vec3d{unit(random), unit(random), unit(random)}; };
  IndexedMesh soup;
  for (std::uint32_t f = 0; f < static_cast<std::uint32_t>(faces); ++f) {
    const Vec3d center = point();
    for (int k = 0; k < 3; ++k) soup.positions.push_back(center + size * point());
    soup.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return soup;
}

TEST(DistanceBound, IsSharpBetweenRandomSoups) {
  std::mt19937 random(11);
  for (int i = 0; i < 20; ++i) {
    const IndexedMesh a = random_soup(random, 8, 0.7), b = random_soup(random, 3 + 5 * i, 0.4);
    expect_sharp("soup " + std::to_string(i), a, b);
    expect_sharp("back " + std::to_string(i), b, a);
  }
}

TEST(DistanceBound, FindsAPeakInsideAFace) {
  const IndexedMesh flat{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}, {{0, 1, 2}}};
  const IndexedMesh pit{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {2, 2, -1}},
                        {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const Bounds bounds = bounds_of(flat, pit);
  EXPECT_GE(bounds.bound, sampled_maximum(flat, pit));
  EXPECT_NEAR(bounds.reached, sampled_maximum(flat, pit), 0.1 * bounds.reached);
}

TEST(DistanceBound, IsNothingBetweenMeshesOfOnePlane) {
  const Bounds bounds = bounds_of(shapes::grid(7, 7), shapes::grid(14, 21));
  EXPECT_LE(bounds.bound, kNoDistance);
}

// Its record names, for every face that it looks at, a bound, and faces that are that near.
TEST(DistanceBound, RecordsWhatItProves) {
  const IndexedMesh a = shapes::bumped(shapes::torus(40, 30), 0.1), b = shapes::torus(20, 30);
  const Surface source = unit_surface(a), target = unit_surface(b);
  FaceMarks marks(source.tree());
  for (std::uint32_t face = 0; face < source.face_count(); face += 3) marks.mark(face);
  std::vector<FaceDistance> of_source, of_target;
  DistanceBound distance(source, target, kTolerance, 2, &marks, {&of_source, &of_target});
  distance.find();
  EXPECT_EQ(of_source.size(), (source.face_count() + 2) / 3);
  for (const FaceDistance& bound : of_source) {
    const Corners t = source.corners(bound.face);
    EXPECT_EQ(bound.face % 3, 0u);
    EXPECT_LE(std::sqrt(target.nearest(t.a, kNoIndex).squared), bound.distance + 1e-12);
  }
  const auto farthest = std::max_element(
      of_target.begin(), of_target.end(),
      [](const FaceDistance& x, const FaceDistance& y) { return x.distance < y.distance; });
  EXPECT_EQ(farthest->distance, distance.bound());
  ASSERT_TRUE(distance.farthest());
  EXPECT_DOUBLE_EQ(std::sqrt(target.nearest(*distance.farthest(), kNoIndex).squared),
                   distance.reached());
}

TEST(DistanceBound, IsTheSameWhateverTheThreads) {
  const IndexedMesh a = shapes::bumped(shapes::torus(60, 40), 0.1), b = shapes::torus(20, 30);
  const Bounds one = bounds_of(a, b, 1), many = bounds_of(a, b, 4);
  EXPECT_EQ(one.reached, many.reached);
  EXPECT_EQ(one.bound, many.bound);
}

}  // namespace
}  // namespace pmesh
