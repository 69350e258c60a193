#include "core/decimate/ring_lanes.h"

#include <gtest/gtest.h>

#include "core/metrics/blended_qem.h"
#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

TEST(RingLanes, HoldTheRingsOfOneRing) {
  const WorkingMesh work(half_edges(shapes::icosphere(1)), shapes::icosphere(1).positions);
  RingLanes rings;
  for (const std::uint32_t v : {0u, 20u, 5u}) ASSERT_TRUE(rings.add(work, VertexId(v)));
  rings.close();
  EXPECT_EQ(rings.rows, 6u);
  for (std::uint32_t lane = 0; lane < rings.used; ++lane) {
    OneRing ring;
    ASSERT_TRUE(gather_neighbours(work.mesh(), rings.centre[lane], ring));
    gather_positions(work, ring);
    ASSERT_EQ(rings.count[lane], ring.neighbours);
    EXPECT_EQ(rings.origin[lane], ring.origin);
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      EXPECT_EQ(rings.ids[lane][i], ring.ids[i]);
      EXPECT_EQ(rings.position(lane, i), ring.position(i));
    }
    EXPECT_EQ(rings.position(lane, ring.neighbours), ring.position(0));
  }
}

TEST(RingLanes, AreNotForBordersAndHubs) {
  const IndexedMesh grid = shapes::grid(3, 3);
  const WorkingMesh flat(half_edges(grid), grid.positions);
  const IndexedMesh hub = shapes::hub(RingLanes::kMaxNeighbours + 1);
  const WorkingMesh wheel(half_edges(hub), hub.positions);
  RingLanes rings;
  EXPECT_FALSE(rings.add(flat, VertexId(0)));
  EXPECT_FALSE(rings.add(wheel, VertexId(0)));
  EXPECT_EQ(rings.used, 0u);
}

TEST(RingLanes, ArePricedToTheBitAsOneRings) {
  const IndexedMesh torus = shapes::bumped(shapes::torus(24, 12), 0.05);
  const WorkingMesh work(half_edges(torus), torus.positions);
  BlendedQem metric;
  metric.start(work.mesh(), work.positions(), work.frame());
  for (std::uint32_t v = 0; v < torus.positions.size(); v += 3) {
    RingLanes rings;
    for (std::uint32_t i = 0; i < 3; ++i) ASSERT_TRUE(rings.add(work, VertexId(v + i)));
    rings.close();
    LaneCosts costs;
    metric.price(rings, costs);
    for (std::uint32_t lane = 0; lane < rings.used; ++lane) {
      OneRing ring;
      ASSERT_TRUE(gather_neighbours(work.mesh(), rings.centre[lane], ring));
      gather_positions(work, ring);
      gather_faces(ring);
      for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
        EXPECT_EQ(costs[i][lane], metric.cost(ring, metric.prepare(ring), i, {}));
      }
    }
  }
}

TEST(RingLanes, ChooseTheCheapestHead) {
  const WorkingMesh work(half_edges(shapes::icosphere(1)), shapes::icosphere(1).positions);
  RingLanes rings;
  for (const std::uint32_t v : {0u, 20u}) ASSERT_TRUE(rings.add(work, VertexId(v)));
  rings.close();
  LaneCosts costs{};  // the first has five neighbours: its sixth cost is no head's
  for (std::uint32_t i = 0; i < 5; ++i) costs[i] = {{5.0 - i, 1, 0, 0}};
  costs[5] = {{0, 1, 0, 0}};
  const LaneChoices choices = choose_heads(rings, costs, 1e-6);
  EXPECT_EQ(choices.best[0], 4);
  EXPECT_EQ(choices.alike[0], 1);
  EXPECT_EQ(choices.best[1], 0);
  EXPECT_EQ(choices.alike[1], 6);
  EXPECT_GT(choices.off_centre[0], 0);
}

}  // namespace
}  // namespace pmesh
