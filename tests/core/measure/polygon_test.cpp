#include "core/measure/polygon.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

const Corners kTriangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

double area(const ConvexPolygon& polygon) {
  Vec3d sum;
  const auto corners = polygon.corners();
  for (std::size_t k = 2; k < corners.size(); ++k) {
    sum += cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
  }
  return length(sum) / 2;
}

TEST(ConvexPolygon, FallsIntoTwoPartsAlongAPlane) {
  const auto [below, above] = ConvexPolygon(kTriangle).cut({{1, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(below.corners().size(), 4u);
  EXPECT_EQ(above.corners().size(), 3u);
  EXPECT_DOUBLE_EQ(area(below), 3.5);
  EXPECT_DOUBLE_EQ(area(above), 4.5);
}

TEST(ConvexPolygon, StaysWholeBesideAPlane) {
  const ConvexPolygon whole(kTriangle);
  const auto low = whole.cut({{5, 0, 0}, {1, 0, 0}});
  EXPECT_DOUBLE_EQ(area(low.below), 8);
  EXPECT_TRUE(low.above.empty());
  const auto high = whole.cut({{0, 0, 0}, {1, 0, 0}});  // touches it
  EXPECT_TRUE(high.below.empty());
  EXPECT_DOUBLE_EQ(area(high.above), 8);
}

TEST(ConvexPolygon, KeepsItsAreaThroughManyCuts) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<ConvexPolygon> pieces = {ConvexPolygon(kTriangle)};
  for (int cut = 0; cut < 400; ++cut) {
    const ConvexPolygon piece = pieces.back();
    pieces.pop_back();
    const Plane plane{piece.extent().middle(), {unit(random), unit(random), unit(random)}};
    const auto parts = piece.can_be_cut() ? piece.cut(plane) : piece.cut_by_diagonal();
    for (const ConvexPolygon& part : {parts.below, parts.above}) {
      if (!part.empty()) pieces.insert(pieces.begin(), part);
    }
  }
  double sum = 0;
  for (const ConvexPolygon& piece : pieces) sum += area(piece);
  EXPECT_GT(pieces.size(), 300u);
  EXPECT_NEAR(sum, 8, 1e-9);
}

TEST(ConvexPolygon, HasNoCornerBeyondItsRadius) {
  const ConvexPolygon triangle(kTriangle);
  const Vec3d middle = triangle.extent().middle();
  EXPECT_DOUBLE_EQ(length(triangle.extent().to - triangle.extent().from), std::sqrt(32.0));
  for (const Vec3d corner : triangle.corners()) {
    EXPECT_LE(length(corner - middle), triangle.radius_about(middle));
  }
}

}  // namespace
}  // namespace pmesh
