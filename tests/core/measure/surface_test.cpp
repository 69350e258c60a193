#include "core/measure/surface.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/core/measure/unit_surface.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

double least_squared_distance(const Surface& surface, Vec3d p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t face = 0; face < surface.face_count(); ++face) {
    least = std::min(least, surface.squared_distance(p, face));
  }
  return least;
}

TEST(Surface, FindsTheNearestFaceOfEveryShape) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.5, 1.5);
  for (const auto& shapes : {shapes::manifolds(), shapes::non_manifolds()}) {
    for (const shapes::Shape& shape : shapes) {
      const Surface surface = unit_surface(shape.mesh);
      for (int i = 0; i < 50; ++i) {
        const Vec3d p{unit(random), unit(random), unit(random)};
        const NearestFace nearest = surface.nearest(p, kNoIndex);
        EXPECT_EQ(nearest.squared, least_squared_distance(surface, p)) << shape.name;
        EXPECT_EQ(surface.squared_distance(p, nearest.face), nearest.squared) << shape.name;
      }
    }
  }
}

TEST(Surface, FindsPointsOnItself) {
  const IndexedMesh mesh = shapes::bumped(shapes::icosphere(4), 0.1);
  const Surface surface = unit_surface(mesh);
  for (const Vec3d p : mesh.positions) EXPECT_EQ(surface.nearest(p, kNoIndex).squared, 0);
}

TEST(Surface, AnswersTheSameWhateverTheHint) {
  const Surface surface = unit_surface(shapes::torus(30, 20));
  const Vec3d p{0.3, 0.4, 0.2};
  const double expected = surface.nearest(p, kNoIndex).squared;
  for (std::uint32_t hint = 0; hint < surface.face_count(); ++hint) {
    EXPECT_EQ(surface.nearest(p, hint).squared, expected);
  }
}

TEST(Surface, KeepsEveryFaceInWhateverOrder) {
  const IndexedMesh mesh = shapes::genus(3);
  const Surface surface = unit_surface(mesh);
  std::vector<Triangle> kept, given = mesh.triangles;
  for (std::uint32_t f = 0; f < surface.face_count(); ++f)
    kept.push_back(mesh.triangles[surface.given_face(f)]);
  std::sort(kept.begin(), kept.end());
  std::sort(given.begin(), given.end());
  EXPECT_EQ(kept, given);
}

TEST(UnitFrame, TakesAnyFiniteBoxIntoTheUnitCube) {
  for (const double size : {1e-300, 1.0, 1e6, 1e300}) {
    const Box<double> box{{size, -size, 0}, {1.5 * size, 0, 0}};
    const auto frame = unit_frame(box);
    ASSERT_TRUE(frame);
    const double half = std::abs(frame->to_unit(box.low).y);
    EXPECT_GE(half, 0.5);
    EXPECT_LE(half, 1);
    EXPECT_DOUBLE_EQ(frame->to_length(2 * half), size);
  }
}

TEST(UnitFrame, RefusesABoxWithoutASize) {
  EXPECT_FALSE(unit_frame({{-1.5e308, 0, 0}, {1.5e308, 0, 0}}));
}

}  // namespace
}  // namespace pmesh
