// HalfEdgeMesh::validate() against broken meshes. No public call breaks a mesh but a collapse that
// ignores its precondition; for the rest the tests write through corners().
#include <gtest/gtest.h>

#include "core/mesh/half_edge_mesh.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

HalfEdgeMesh built(const IndexedMesh& mesh) {
  Result<HalfEdgeMesh> result =
      HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
  EXPECT_TRUE(result);
  return std::move(result).value();
}

VertexId& corner(HalfEdgeMesh& mesh, std::uint32_t half_edge) {
  return const_cast<VertexId&>(mesh.corners()[half_edge]);
}

std::string complaint(const HalfEdgeMesh& mesh) {
  const Status status = mesh.validate();
  return status ? "none" : status.error().message;
}

TEST(HalfEdgeMeshValidate, CatchesEveryWrongCorner) {
  const HalfEdgeMesh good = built(shapes::grid(3, 2));
  ASSERT_TRUE(good.validate());
  for (std::uint32_t h = 0; h < 3 * good.face_slots(); ++h) {
    for (std::uint32_t v = 0; v <= good.vertex_slots(); ++v) {
      HalfEdgeMesh bad = good;
      corner(bad, h) = VertexId(v);
      EXPECT_EQ(bool(bad.validate()), VertexId(v) == good.origin(HalfEdgeId(h))) << h << ' ' << v;
    }
  }
}

TEST(HalfEdgeMeshValidate, CatchesAWrongTwin) {
  HalfEdgeMesh mesh = built(shapes::octahedron());
  for (std::uint32_t k = 0; k < 3; ++k) std::swap(corner(mesh, k), corner(mesh, 6 + k));
  EXPECT_EQ(complaint(mesh), "face 0 has a wrong twin");
}

TEST(HalfEdgeMeshValidate, CatchesAWrongOutgoingHalfEdge) {
  HalfEdgeMesh mesh = built(shapes::isolated_triangles(1));
  std::swap(corner(mesh, 0), corner(mesh, 1));
  EXPECT_EQ(complaint(mesh), "vertex 0 has a wrong outgoing half-edge");
}

TEST(HalfEdgeMeshValidate, CatchesADeadFaceThatCounts) {
  HalfEdgeMesh mesh = built(shapes::octahedron());
  for (std::uint32_t k = 0; k < 3; ++k) corner(mesh, k) = VertexId();
  EXPECT_EQ(complaint(mesh), "the live counts are wrong");
}

TEST(HalfEdgeMeshValidate, CatchesACollapseThatFoldsFacesTogether) {
  // Around the narrow side of a torus three vertices are mutual neighbours without a face.
  HalfEdgeMesh mesh = built(shapes::torus(5, 3));
  mesh.collapse(VertexId(0), mesh.find_edge(VertexId(0), VertexId(1)));
  EXPECT_NE(complaint(mesh), "none");
}

TEST(HalfEdgeMeshValidate, CatchesACollapseOfTheLastFace) {
  HalfEdgeMesh mesh = built(shapes::isolated_triangles(2));
  mesh.collapse(VertexId(0), mesh.find_edge(VertexId(0), VertexId(1)));
  EXPECT_NE(complaint(mesh), "none");
}

}  // namespace
}  // namespace pmesh
