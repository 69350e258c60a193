#include "core/measure/spatial_order.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

constexpr int kSide = 8;

// The centres of 8 x 8 x 8 cells of [-1, 1]^3.
std::vector<Vec3d> cell_centers() {
  const auto at = [](int i) { return (2 * i + 1.0) / kSide - 1; };
  std::vector<Vec3d> points;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    points.push_back({at(i % kSide), at(i / kSide % kSide), at(i / kSide / kSide)});
  }
  return points;
}

TEST(SpatialOrder, VisitsEveryPointOnce) {
  std::vector<std::uint32_t> order = spatial_order(cell_centers(), 2);
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> all(order.size());
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(order, all);
}

TEST(SpatialOrder, GoesFromCellToNeighbouringCell) {
  const std::vector<Vec3d> points = cell_centers();
  const std::vector<std::uint32_t> order = spatial_order(points, 1);
  ASSERT_EQ(order.size(), points.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    EXPECT_DOUBLE_EQ(length(points[order[i]] - points[order[i - 1]]), 2.0 / kSide);
  }
}

TEST(SpatialOrder, TakesPointsFromOutside) {
  const std::vector<Vec3d> points = {{1e300, 0, 0}, {-1e300, 0, 0}, {0, 7, -7}};
  EXPECT_EQ(spatial_order(points, 1).size(), 3u);
}

}  // namespace
}  // namespace pmesh
