#include "core/measure/compare.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/io/import.h"
#include "tests/fixtures/real_meshes.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

Comparison compared(const IndexedMesh& a, const IndexedMesh& b, CompareOptions options = {}) {
  options.samples = 20'000;
  const Result<Comparison> comparison = compare_surfaces(a, b, options);
  EXPECT_TRUE(comparison);
  return *comparison;
}

IndexedMesh scaled(IndexedMesh mesh, double factor) {
  for (Vec3d& p : mesh.positions) p = factor * p;
  return mesh;
}

TEST(Compare, FindsNoDistanceToItself) {
  const IndexedMesh mesh = shapes::bumped(shapes::torus(20, 12), 0.05);
  const Comparison same = compared(mesh, mesh);
  EXPECT_LT(same.max(), 1e-14);
  EXPECT_LT(same.rms(), 1e-14);
}

TEST(Compare, MeasuresParallelPlanes) {
  const IndexedMesh plane = shapes::grid(9, 9);
  const Comparison apart = compared(plane, shapes::moved(shapes::grid(4, 7), {0, 0, 0.25}));
  for (const SurfaceDistance& way : {apart.forward, apart.backward}) {
    EXPECT_DOUBLE_EQ(way.max, 0.25);
    EXPECT_NEAR(way.mean, 0.25, 1e-12);
    EXPECT_NEAR(way.rms, 0.25, 1e-12);
  }
}

TEST(Compare, MeasuresConcentricSpheres) {
  const Comparison apart = compared(shapes::icosphere(5), scaled(shapes::icosphere(5), 1.5));
  EXPECT_NEAR(apart.forward.mean, 0.5, 0.002);
  EXPECT_NEAR(apart.backward.mean, 0.5, 0.002);
  EXPECT_NEAR(apart.rms(), 0.5, 0.002);
  EXPECT_NEAR(apart.bbox_diagonal, std::sqrt(12.0), 0.01);
}

// A square of side 1 against its left half: the mean of max(0, x - 1/2), and of its square.
TEST(Compare, WeighsByArea) {
  IndexedMesh square = shapes::grid(30, 30), half = shapes::grid(15, 30);
  double side = 0;
  for (const Vec3d p : square.positions) side = std::max(side, p.x);
  for (Vec3d& p : square.positions) p = (1 / side) * p;
  double half_side = 0;
  for (const Vec3d p : half.positions) half_side = std::max(half_side, p.x);
  for (Vec3d& p : half.positions) p = {p.x / half_side / 2, p.y / side, 0};
  const Comparison cut = compared(square, half);
  EXPECT_DOUBLE_EQ(cut.forward.max, 0.5);
  EXPECT_NEAR(cut.forward.mean, 0.125, 0.002);
  EXPECT_NEAR(cut.forward.rms, std::sqrt(1.0 / 24), 0.002);
  EXPECT_LT(cut.backward.max, 1e-14);
}

TEST(Compare, IsTheSameWhateverTheThreads) {
  const IndexedMesh a = shapes::bumped(shapes::icosphere(5), 0.1), b = shapes::icosphere(3);
  CompareOptions options;
  const Comparison one = compared(a, b, options);
  for (const unsigned threads : {2u, 5u}) {
    options.threads = threads;
    const Comparison many = compared(a, b, options);
    EXPECT_EQ(many.forward.max, one.forward.max);
    EXPECT_EQ(many.forward.mean, one.forward.mean);
    EXPECT_EQ(many.backward.rms, one.backward.rms);
  }
}

TEST(Compare, IsTheSameFarFromTheOriginAndInAnyUnit) {
  const IndexedMesh a = shapes::bumped(shapes::icosphere(4), 0.1), b = shapes::icosphere(3);
  const double near = compared(a, b).rms();
  const Vec3d away{4e6, 5e5, 0};
  EXPECT_NEAR(compared(shapes::moved(a, away), shapes::moved(b, away)).rms(), near, 1e-8);
  for (const double unit : {std::ldexp(1.0, -700), std::ldexp(1.0, 700)}) {
    EXPECT_NEAR(compared(scaled(a, unit), scaled(b, unit)).rms() / unit, near, 1e-8);
  }
}

TEST(Compare, RefusesWhatCannotBeMeasured) {
  EXPECT_FALSE(compare_surfaces({}, shapes::tetrahedron(), {}));
  EXPECT_FALSE(compare_surfaces(shapes::tetrahedron(), {{{0, 0, 0}}, {}}, {}));
  const IndexedMesh huge{{{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_FALSE(compare_surfaces(huge, huge, {}));
}

TEST(Compare, MeasuresSurfacesWithoutArea) {
  const IndexedMesh line{{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {{0, 1, 2}}};
  const Comparison lines = compared(line, shapes::moved(line, {0, 2, 0}));
  EXPECT_DOUBLE_EQ(lines.max(), 2);
  EXPECT_NEAR(lines.rms(), 2, 1e-12);
}

TEST(Compare, HardlyDependsOnTheSeedForARealMesh) {
  PMESH_NEED_REAL_MESH(path, "cow.obj");
  const Result<ImportedMesh> cow = import_mesh(path);
  ASSERT_TRUE(cow);
  const IndexedMesh rounded = shapes::bumped(cow->mesh, 0.01);
  CompareOptions options;
  const Comparison first = compared(cow->mesh, rounded, options);
  options.seed = 1;
  EXPECT_NEAR(compared(cow->mesh, rounded, options).rms() / first.rms(), 1, 0.02);
}

}  // namespace
}  // namespace pmesh
