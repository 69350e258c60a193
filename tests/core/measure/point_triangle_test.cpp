#include "core/measure/point_triangle.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

const Vec3d kA{0, 0, 0}, kB{4, 0, 0}, kC{0, 3, 0};

double distance(Vec3d p, Vec3d a = kA, Vec3d b = kB, Vec3d c = kC) {
  return std::sqrt(squared_distance_to_triangle(p, a, b, c));
}

TEST(PointTriangle, IsExactInEveryRegion) {
  EXPECT_DOUBLE_EQ(distance({1, 1, 2}), 2);    // above the face
  EXPECT_DOUBLE_EQ(distance({-3, -4, 0}), 5);  // beyond each corner
  EXPECT_DOUBLE_EQ(distance({7, -4, 0}), 5);
  EXPECT_DOUBLE_EQ(distance({-3, 7, 0}), 5);
  EXPECT_DOUBLE_EQ(distance({2, -1, 0}), 1);  // beyond each edge
  EXPECT_DOUBLE_EQ(distance({-1, 1, 0}), 1);
  EXPECT_DOUBLE_EQ(distance({2 + 3, 1.5 + 4, 0}), 5);
}

TEST(PointTriangle, IsZeroAtCorners) {
  for (const Vec3d corner : {kA, kB, kC}) EXPECT_EQ(distance(corner), 0);
}

TEST(PointTriangle, TakesSegmentsAndPointsForTriangles) {
  EXPECT_DOUBLE_EQ(distance({2, 3, 4}, kA, kB, kB), 5);
  EXPECT_DOUBLE_EQ(distance({2, 3, 4}, kA, kB, {1, 0, 0}), 5);
  EXPECT_DOUBLE_EQ(distance({2, 3, 6}, kA, kA, kA), 7);
}

// The least distance to a fine grid of the triangle's points: above the true one, by little.
TEST(PointTriangle, AgreesWithItsPointsForThinTriangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr int kSteps = 400;
  for (const double thinness : {1.0, 1e-3, 1e-7, 1e-9, 1e-12}) {
    const Vec3d a{unit(random), unit(random), unit(random)};
    const Vec3d b{unit(random), unit(random), unit(random)};
    const Vec3d c = 0.3 * a + 0.7 * b + thinness * Vec3d{unit(random), unit(random), unit(random)};
    const Vec3d p{unit(random), unit(random), unit(random)};
    double least = 1e9;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Vec3d q = a + (1.0 * i / kSteps) * (b - a) + (1.0 * j / kSteps) * (c - a);
        least = std::min(least, length(p - q));
      }
    }
    EXPECT_LE(distance(p, a, b, c), least + 1e-8);
    EXPECT_NEAR(distance(p, a, b, c), least, 1e-4);
  }
}

}  // namespace
}  // namespace pmesh
