#include "core/decimate/one_ring.h"

#include <gtest/gtest.h>

#include "core/decimate/legality.h"
#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

TEST(OneRing, ListsNeighboursCounterClockwise) {
  const OneRing ring = ring_of(square(), 4);
  EXPECT_FALSE(ring.border);
  ASSERT_EQ(ring.neighbours, 4u);
  const std::uint32_t start = index_in(ring, 0);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(ring.ids[(start + i) % 4], VertexId(i));
}

TEST(OneRing, OfABorderVertexBeginsAndEndsOnTheBorder) {
  const OneRing ring = ring_of(square(), 0);
  EXPECT_TRUE(ring.border);
  ASSERT_EQ(ring.neighbours, 3u);
  EXPECT_EQ(ring.faces, 2u);
  EXPECT_EQ(ring.ids[0], VertexId(1));
  EXPECT_EQ(ring.ids[2], VertexId(3));
  EXPECT_EQ(ring.beyond_first, (Vec3d{1, 1, 0}));
  EXPECT_EQ(ring.beyond_last, (Vec3d{1, 1, 0}));
}

TEST(OneRing, StopsAtAHub) {
  constexpr int kMax = OneRing::kMaxFaces;
  OneRing ring;
  EXPECT_TRUE(gather_neighbours(half_edges(shapes::hub(kMax)), VertexId(0), ring));
  EXPECT_FALSE(gather_neighbours(half_edges(shapes::hub(kMax + 1)), VertexId(0), ring));
}

TEST(OneRing, LargestOneMovesTheLastFaceToo) {
  constexpr std::uint32_t kMax = OneRing::kMaxFaces;
  const OneRing ring = ring_of(shapes::hub(static_cast<int>(kMax)), 0);
  MovedFaces moved;
  move_faces(ring, kMax - 1, moved);
  EXPECT_EQ(moved.count, kMax - 2);
  EXPECT_GT(moved.area[moved.count - 1], 0);
}

TEST(OneRing, MovedFacesOfAnInteriorVertexAreAllButTwo) {
  const OneRing ring = ring_of(square(), 4);
  const MovedFaces moved = moved_to(ring, 1);
  ASSERT_EQ(moved.count, 2u);
  for (std::uint32_t k = 0; k < 2; ++k) EXPECT_NEAR(moved.nz[k], 1, 1e-15);
  EXPECT_NEAR(moved.area[0] + moved.area[1], 1, 1e-15);
}

TEST(OneRing, FacesWithoutAreaHaveNoNormal) {
  IndexedMesh mesh = square();
  mesh.positions[4] = {0.5, 1e-12, 0};  // Face (0, 1, 4) is a needle.
  const OneRing ring = ring_of(mesh, 4);
  const std::uint32_t needle = index_in(ring, 0);
  EXPECT_EQ(ring.nz[needle], 0);
  EXPECT_DOUBLE_EQ(ring.nz[(needle + 1) % 4], 1);
}

TEST(FoldOver, IsSeenWhenAFaceTurnsOver) {
  // A dart: collapsing 4 to 1 would turn face (2, 3, 4) over the dent at 2.
  IndexedMesh mesh = square();
  mesh.positions[2] = {0.3, 0.3, 0};
  mesh.positions[4] = {0.2, 0.2, 0};
  const OneRing ring = ring_of(mesh, 4);
  EXPECT_TRUE(folds_over(ring, moved_to(ring, 1)));
  EXPECT_FALSE(folds_over(ring, moved_to(ring, 0)));
}

TEST(FoldOver, IsNotSeenInFacesWithoutArea) {
  IndexedMesh mesh = square();
  mesh.positions[2] = {0.3, 0.3, 0};
  mesh.positions[3] = {0.6, 0.6, 0};  // Face (2, 3, 4) lies on the diagonal.
  mesh.positions[4] = {0.2, 0.2, 0};
  const OneRing ring = ring_of(mesh, 4);
  EXPECT_EQ(ring.nz[index_in(ring, 2)], 0);
  EXPECT_FALSE(folds_over(ring, moved_to(ring, 1)));
}

}  // namespace
}  // namespace pmesh
