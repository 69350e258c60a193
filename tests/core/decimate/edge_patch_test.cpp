#include "core/decimate/edge_patch.h"

#include <set>

#include <gtest/gtest.h>

#include "core/decimate/edge_star.h"
#include "tests/core/decimate/rings.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using Edges = std::set<HalfEdgeId>;

// All edges with an end among `ends`, by the lesser of their half-edges.
Edges edges_with_end(const HalfEdgeMesh& mesh, const std::set<VertexId>& ends) {
  Edges edges;
  for (std::uint32_t i = 0; i < 3 * mesh.face_slots(); ++i) {
    const HalfEdgeId h(i);
    if (mesh.twin(h) < h) continue;
    if (ends.contains(mesh.origin(h)) || ends.contains(mesh.target(h))) edges.insert(h);
  }
  return edges;
}

std::set<VertexId> with_neighbours(const HalfEdgeMesh& mesh, VertexId v) {
  OneRing ring;
  EXPECT_TRUE(gather_neighbours(mesh, v, ring));
  std::set<VertexId> vertices(ring.ids.begin(), ring.ids.begin() + ring.neighbours);
  vertices.insert(v);
  return vertices;
}

Edges set_of(std::span<const HalfEdgeId> edges) { return {edges.begin(), edges.end()}; }

class EdgePatchOf : public testing::TestWithParam<bool> {};

TEST_P(EdgePatchOf, HasTheEdgesOfAVertexAndOfItsNeighboursOnce) {
  for (const IndexedMesh& mesh : {shapes::grid(5, 4), shapes::icosphere(1), shapes::torus(5, 4)}) {
    const WorkingMesh work(half_edges(mesh), mesh.positions);
    EdgePatch patch(work, GetParam());
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      patch.gather(VertexId(v));
      EXPECT_EQ(set_of(patch.merged_edges()), edges_with_end(work.mesh(), {VertexId(v)}));
      EXPECT_EQ(set_of(patch.edges()),
                edges_with_end(work.mesh(), with_neighbours(work.mesh(), VertexId(v))));
      EXPECT_EQ(set_of(patch.edges()).size(), patch.edges().size());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithout, EdgePatchOf, testing::Bool());

TEST(EdgePatch, NamesTheCornersOfItsEdges) {
  const IndexedMesh mesh = shapes::grid(5, 4);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  EdgePatch patch(work, true);
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    patch.gather(VertexId(v));
    for (std::size_t i = 0; i < patch.edges().size(); ++i) {
      const auto [a, b, left, right] = patch.corners()[i];
      const HalfEdgeId h = patch.edges()[i], twin = work.mesh().twin(h);
      EXPECT_EQ(patch.vertex(a), work.mesh().origin(h));
      EXPECT_EQ(patch.vertex(b), work.mesh().target(h));
      EXPECT_EQ(patch.vertex(left), work.mesh().apex(h));
      EXPECT_EQ(right == kNoIndex, !twin.valid());
      if (twin.valid()) {
        EXPECT_EQ(patch.vertex(right), work.mesh().apex(twin));
      }
    }
  }
}

TEST(EdgePatch, AroundAHubIsEmpty) {
  const IndexedMesh mesh = shapes::hub(int{OneRing::kMaxFaces} + 1);
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  EdgePatch patch(work, true);
  patch.gather(VertexId(0));
  EXPECT_TRUE(patch.edges().empty());
}

}  // namespace
}  // namespace pmesh
