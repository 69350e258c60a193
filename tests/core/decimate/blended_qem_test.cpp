#include "core/metrics/blended_qem.h"

#include <gtest/gtest.h>

#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

// The cost of collapsing v into its neighbour, in the mesh's own units, for an input in which no
// vertex lies where it lay: so nothing is remembered but the start.
double cost(const IndexedMesh& mesh, std::uint32_t v, std::uint32_t head, double memory) {
  BlendedQem metric(memory);
  metric.start(half_edges(mesh), mesh.positions, MetricFrame{});
  OneRing ring = ring_of(mesh, v);
  ring.origin = mesh.positions[v];
  return metric.cost(ring, metric.prepare(ring), index_in(ring, head), {});
}

TEST(BlendedQem, CostIsAreaTimesSquaredDistanceToTheFacesLeft) {
  // Vertex 0 moves one unit along x, off the face in the plane x = 0, whose area is 1/2.
  EXPECT_NEAR(cost(cube_corner(), 0, 1, 0), 0.5, 1e-12);
}

TEST(BlendedQem, MemoryCountsTheInputsPlanesAgain) {
  EXPECT_NEAR(cost(cube_corner(), 0, 1, 0.3), 1.3 * 0.5, 1e-12);
}

TEST(BlendedQem, MemoryOutlivesTheFaces) {
  const IndexedMesh mesh = cube_corner();
  BlendedQem metric(1);
  metric.start(half_edges(mesh), mesh.positions, MetricFrame{});
  OneRing ring = ring_of(square(), 4);  // flat now, above the corner that was
  ring.centre = VertexId(0);
  ring.origin = {0.5, 0.5, 0};
  EXPECT_NEAR(metric.cost(ring, metric.prepare(ring), index_in(ring, 2), {}), 0.5 + 0.5, 1e-12);
}

TEST(BlendedQem, StraightBordersMayShrinkAndCornersMayNot) {
  const IndexedMesh mesh = shapes::grid(4, 4);
  const auto border_cost = [&](std::uint32_t v) {
    return cost(mesh, v, ring_of(mesh, v).ids[0].value, BlendedQem::kDefaultMemory);
  };
  EXPECT_NEAR(border_cost(1), 0, 1e-12);
  EXPECT_GT(border_cost(0), 1e-6);
}

}  // namespace
}  // namespace pmesh
