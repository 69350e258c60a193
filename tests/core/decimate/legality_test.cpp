#include "core/decimate/legality.h"

#include <gtest/gtest.h>

#include "core/decimate/one_ring.h"
#include "tests/core/decimate/rings.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

bool is_legal(const IndexedMesh& mesh, std::uint32_t removed, std::uint32_t kept) {
  const HalfEdgeMesh connectivity = half_edges(mesh);
  OneRing ring;
  EXPECT_TRUE(gather_neighbours(connectivity, VertexId(removed), ring));
  const std::uint32_t head = index_in(ring, kept);
  return may_move_to(ring, head) && link_condition_holds(connectivity, ring, head);
}

TEST(Legality, KeepsTheLastFacesOfAComponent) {
  EXPECT_FALSE(is_legal(shapes::tetrahedron(), 0, 1));
  EXPECT_FALSE(is_legal(shapes::isolated_triangles(1), 0, 1));
  EXPECT_TRUE(is_legal(shapes::octahedron(), 0, 2));
}

TEST(Legality, InteriorVertexOfThreeFacesMayLeaveATriangle) {
  EXPECT_TRUE(is_legal(cube_corner(), 0, 1));
}

TEST(Legality, BorderVertexMovesAlongItsBorderOnly) {
  EXPECT_FALSE(is_legal(square(), 0, 4));
  EXPECT_TRUE(is_legal(square(), 0, 1));
  EXPECT_TRUE(is_legal(square(), 4, 0));
}

TEST(Legality, InteriorEdgeBetweenBordersStays) {
  // Two triangles with a common edge (0, 2).
  const IndexedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_FALSE(is_legal(mesh, 0, 2));
  EXPECT_TRUE(is_legal(mesh, 0, 1));
}

TEST(Legality, ThirdCommonNeighbourForbidsTheCollapse) {
  // Around the tube of a 4 x 3 torus every edge closes a triangle that is no face.
  EXPECT_FALSE(is_legal(shapes::torus(4, 3), 0, 1));
}

TEST(Legality, AgreesWithTheLinkConditionAsDefined) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    const HalfEdgeMesh mesh = half_edges(shape.mesh);
    OneRing ring;
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
      if (!gather_neighbours(mesh, VertexId(v), ring)) continue;
      for (std::uint32_t head = 0; head < ring.neighbours; ++head) {
        const bool legal = may_move_to(ring, head) && link_condition_holds(mesh, ring, head);
        const HalfEdgeId edge = mesh.find_edge(VertexId(v), ring.ids[head]);
        EXPECT_EQ(legal, may_collapse(mesh, VertexId(v), edge))
            << shape.name << ": " << v << " into " << ring.ids[head].value;
      }
    }
  }
}

}  // namespace
}  // namespace pmesh
