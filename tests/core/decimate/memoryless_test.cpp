#include "core/metrics/memoryless.h"

#include <gtest/gtest.h>

#include "core/decimate/edge_star.h"
#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

EdgeStar star_of(const WorkingMesh& work, std::uint32_t a, std::uint32_t b) {
  EdgeStar star;
  gather_ends(work, work.mesh().find_edge(VertexId(a), VertexId(b)), star);
  EXPECT_TRUE(gather_star(work, star));
  return star;
}

Memoryless::Summary summary_of(const WorkingMesh& work, VertexId v) {
  PlacedRing ring;
  EXPECT_TRUE(gather_ring(work, v, ring));
  return Memoryless().summarise(ring);
}

Placement place(const WorkingMesh& work, const EdgeStar& star) {
  const Memoryless::Summary a = summary_of(work, star.a), b = summary_of(work, star.b);
  const SummedEdge<Memoryless::Summary> edge{star, &a, &b};
  Placement placement;
  Memoryless().place(std::span(&edge, 1), std::span(&placement, 1));
  return placement;
}

// Six times the volume between the surface of the star and its midpoint, once the ends are at
// `position` (which must be what the star's faces are then measured from).
double volume(const EdgeStar& star, const Vec3d* position) {
  double sum = 0;
  for (const EdgeStar::Face& f : star.faces) {
    sum += dot(position != nullptr ? *position : f.end, cross(f.second, f.third));
  }
  if (position != nullptr) return sum;
  sum += dot(star.position_a, cross(star.position_b, star.left));
  if (!star.on_border) sum += dot(star.position_b, cross(star.position_a, star.right));
  return sum;
}

TEST(EdgeStar, ListsTheSurvivingFacesAndTheBorders) {
  const IndexedMesh mesh = shapes::grid(3, 3);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  const HalfEdgeId corner_edge = work.mesh().outgoing(VertexId(0));
  const EdgeStar star = star_of(work, 0, work.mesh().target(corner_edge).value);
  EXPECT_TRUE(star.on_border);
  EXPECT_TRUE(star.a_on_border && star.b_on_border);
  EXPECT_EQ(star.borders.size(), 3u);
}

TEST(EdgeStar, OfAnInteriorEdgeHasAllFacesButTwo) {
  const IndexedMesh mesh = shapes::icosphere(0);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  const EdgeStar star =
      star_of(work, 0, work.mesh().target(work.mesh().outgoing(VertexId(0))).value);
  EXPECT_EQ(star.faces.size(), 5u + 5 - 4);
  EXPECT_FALSE(star.on_border);
  EXPECT_TRUE(star.borders.empty());
}

TEST(Memoryless, PreservesTheVolume) {
  const IndexedMesh mesh = shapes::bumped(shapes::icosphere(2), 0.05);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  for (std::uint32_t v = 0; v < 20; ++v) {
    const VertexId neighbour = work.mesh().target(work.mesh().outgoing(VertexId(v)));
    const EdgeStar star = star_of(work, v, neighbour.value);
    const Placement placement = place(work, star);
    EXPECT_NEAR(volume(star, &placement.position), volume(star, nullptr), 1e-14);
  }
}

TEST(Memoryless, PlacesAnEdgeAloneAsAmongOthers) {
  const IndexedMesh mesh = shapes::bumped(shapes::grid(6, 6), 0.05);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  std::vector<Memoryless::Summary> summaries(2 * 40);
  std::vector<SummedEdge<Memoryless::Summary>> edges(40);
  std::vector<Placement> placements(40);
  for (std::uint32_t v = 0; v < 40; ++v) {
    const VertexId neighbour = work.mesh().target(work.mesh().outgoing(VertexId(v)));
    summaries[2 * v] = summary_of(work, VertexId(v));
    summaries[2 * v + 1] = summary_of(work, neighbour);
    edges[v] = {star_of(work, v, neighbour.value), &summaries[2 * v], &summaries[2 * v + 1]};
  }
  Memoryless().place(edges, placements);
  for (std::uint32_t v = 0; v < 40; ++v) {
    Placement alone;
    Memoryless().place(std::span(&edges[v], 1), std::span(&alone, 1));
    EXPECT_EQ(alone.cost, placements[v].cost) << v;
    EXPECT_EQ(alone.position, placements[v].position) << v;
  }
}

TEST(Memoryless, CollapseInAPlaneIsFreeAndStaysInIt) {
  const IndexedMesh mesh = shapes::grid(6, 6);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  const Placement placement = place(work, star_of(work, 3 * 7 + 3, 3 * 7 + 4));
  EXPECT_NEAR(placement.cost, 0, 1e-20);
  EXPECT_NEAR(placement.position.z, 0, 1e-12);
}

TEST(Memoryless, StraightBorderKeepsItsLine) {
  const IndexedMesh mesh = shapes::grid(6, 6);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  const EdgeStar star = star_of(work, 2, 3);
  ASSERT_TRUE(star.on_border);
  const Placement placement = place(work, star);
  const Vec3d along = star.position_b - star.position_a;
  EXPECT_LT(length(cross(placement.position, along)), 1e-12);
  EXPECT_NEAR(placement.cost, 0, 1e-15);
}

}  // namespace
}  // namespace pmesh
