#include "core/metrics/triangle_collapse.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/metrics/table.h"

namespace pmesh {
namespace {

// A flat big triangle of area 2, its corners in the middle of its sides.
TriangleStar flat_star() {
  TriangleStar star;
  star.apexes = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}};
  star.positions = {{{1, 1, 0}, {0, 1, 0}, {1, 0, 0}}};
  return star;
}

// The same, its first apex turned out of the plane by that angle.
TriangleStar bent_star(double degrees) {
  TriangleStar star = flat_star();
  const double angle = degrees * std::numbers::pi / 180;
  const Vec3d hinge{0.5, 0.5, 0};  // on the edge across from corner 0
  const double reach = std::sqrt(0.5);
  star.apexes[0] =
      hinge + reach * Vec3d{-std::cos(angle) * reach, -std::cos(angle) * reach, std::sin(angle)};
  return star;
}

TEST(TriangleCollapse, CostsTheHeightOfTheMeanOverTheArea) {
  TriangleStar star = flat_star();
  EXPECT_EQ(TriangleCollapse().cost(star), 0);
  for (Vec3d& corner : star.positions) corner.z = 0.5;  // the six vertices' mean is at 0.25
  EXPECT_DOUBLE_EQ(TriangleCollapse().cost(star), 0.25 / 2);
}

TEST(TriangleCollapse, CostsLessInALargerTriangleOfTheSameShape) {
  TriangleStar star = flat_star();
  for (Vec3d& corner : star.positions) corner.z = 0.5;
  const double cost = TriangleCollapse().cost(star);
  for (Vec3d& p : star.positions) p = 2.0 * p;
  for (Vec3d& p : star.apexes) p = 2.0 * p;
  EXPECT_DOUBLE_EQ(TriangleCollapse().cost(star), cost / 2);
}

TEST(TriangleCollapse, WithoutAreaComesLast) {
  TriangleStar star = flat_star();
  star.apexes[2] = star.apexes[1];
  EXPECT_EQ(TriangleCollapse().cost(star), std::numeric_limits<double>::max());
}

TEST(TriangleCollapse, IsPlanarIfEveryAngleExceedsTheParameter) {
  EXPECT_TRUE(TriangleCollapse().is_planar(flat_star()));
  EXPECT_TRUE(TriangleCollapse().is_planar(bent_star(14.9)));
  EXPECT_FALSE(TriangleCollapse().is_planar(bent_star(15.1)));
  EXPECT_FALSE(TriangleCollapse().is_planar(bent_star(-15.1)));
  EXPECT_TRUE(TriangleCollapse(90).is_planar(bent_star(89)));
  EXPECT_FALSE(TriangleCollapse(90).is_planar(bent_star(91)));
}

TEST(TriangleCollapse, NeighboursWithoutAreaDoNotCount) {
  TriangleStar star = flat_star();
  star.apexes[0] = star.positions[1];
  EXPECT_TRUE(TriangleCollapse().is_planar(star));
  star.positions[0] = star.positions[1];
  EXPECT_FALSE(TriangleCollapse().is_planar(star));
}

TEST(TriangleCollapse, LetsFacesTurnByTwiceTheAngleInEveryRound) {
  const TriangleCollapse metric;
  EXPECT_NEAR(std::acos(metric.least_cosine(0)), std::numbers::pi / 180, 1e-12);
  EXPECT_NEAR(std::acos(metric.least_cosine(6)), 64 * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(metric.least_cosine(7), 0);
}

TEST(TriangleCollapse, TakesItsPlanarityFromTheParameters) {
  EXPECT_EQ(metric_parameters(*make_metric("triangle")), "planarity=165");
  EXPECT_EQ(metric_parameters(*make_metric("triangle", "planarity=170.5")), "planarity=170.5");
  EXPECT_FALSE(make_metric("triangle", "planarity=181"));
  EXPECT_FALSE(make_metric("triangle", "planarity=-1"));
}

}  // namespace
}  // namespace pmesh
