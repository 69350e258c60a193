#include <gtest/gtest.h>

#include "core/mesh/half_edge_mesh.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

Result<HalfEdgeMesh> build(const IndexedMesh& mesh) {
  return HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
}

std::string build_error(const std::vector<Triangle>& triangles, std::uint32_t vertex_count) {
  const Result<HalfEdgeMesh> mesh = HalfEdgeMesh::build(triangles, vertex_count);
  if (mesh) return "no error";
  EXPECT_EQ(mesh.error().code, ErrorCode::bad_input);
  return mesh.error().message;
}

TEST(HalfEdgeMeshBuild, AcceptsEveryManifoldShape) {
  for (const auto& [name, shape] : shapes::manifolds()) {
    const Result<HalfEdgeMesh> mesh = build(shape);
    ASSERT_TRUE(mesh) << name << ": " << mesh.error().message;
    EXPECT_TRUE(mesh->validate()) << name;
    EXPECT_EQ(mesh->live_faces(), shape.triangles.size()) << name;
    EXPECT_EQ(mesh->live_vertices(), shape.positions.size()) << name;
  }
}

TEST(HalfEdgeMeshBuild, RefusesEveryNonManifoldShape) {
  for (const auto& [name, shape] : shapes::non_manifolds()) EXPECT_FALSE(build(shape)) << name;
}

TEST(HalfEdgeMeshBuild, AcceptsTheEmptyMesh) {
  const Result<HalfEdgeMesh> mesh = HalfEdgeMesh::build({}, 0);
  ASSERT_TRUE(mesh);
  EXPECT_TRUE(mesh->validate());
}

TEST(HalfEdgeMeshBuild, SeesTheHandlesOfGenus20) {
  const Result<HalfEdgeMesh> mesh = build(shapes::genus(20));
  ASSERT_TRUE(mesh);
  const std::int64_t faces = mesh->live_faces();
  EXPECT_EQ(mesh->live_vertices() - faces / 2, 2 - 2 * 20);  // V - E + F, with 2 E = 3 F
}

TEST(HalfEdgeMeshBuild, KeepsCornersInPlace) {
  const Result<HalfEdgeMesh> mesh = build(shapes::tetrahedron());
  ASSERT_TRUE(mesh);
  const std::vector<Triangle> triangles = shapes::tetrahedron().triangles;
  for (std::uint32_t h = 0; h < 12; ++h) {
    EXPECT_EQ(mesh->origin(HalfEdgeId(h)).value, triangles[h / 3][h % 3]);
  }
}

TEST(HalfEdgeMeshBuild, TellsBordersFromInteriors) {
  const Result<HalfEdgeMesh> mesh = build(shapes::hub(5));
  ASSERT_TRUE(mesh);
  EXPECT_FALSE(mesh->is_border(VertexId(0)));
  for (std::uint32_t v = 1; v <= 5; ++v) {
    EXPECT_TRUE(mesh->is_border(VertexId(v)));
    EXPECT_EQ(mesh->origin(mesh->outgoing(VertexId(v))), VertexId(v));
  }
}

TEST(HalfEdgeMeshBuild, RejectsAnIndexOutOfRange) {
  EXPECT_EQ(build_error({{0, 1, 2}, {0, 2, 3}}, 3), "face 1 has a vertex index out of range");
  EXPECT_EQ(build_error({{0, 1, kNoIndex}}, 3), "face 0 has a vertex index out of range");
}

TEST(HalfEdgeMeshBuild, RejectsARepeatedVertex) {
  EXPECT_EQ(build_error({{0, 1, 2}, {2, 1, 2}}, 3), "face 1 repeats a vertex");
}

TEST(HalfEdgeMeshBuild, RejectsAnUnusedVertex) {
  EXPECT_EQ(build_error({{0, 1, 3}}, 4), "vertex 2 has no face");
}

TEST(HalfEdgeMeshBuild, RejectsThreeFacesOnAnEdge) {
  EXPECT_EQ(build_error(shapes::fan_edge(3).triangles, 5), "edge (0, 1) has more than two faces");
}

TEST(HalfEdgeMeshBuild, RejectsDisagreeingOrientations) {
  EXPECT_EQ(build_error({{0, 1, 2}, {0, 1, 3}}, 4),
            "edge (0, 1) has two faces that disagree in orientation");
  EXPECT_EQ(build_error({{0, 1, 2}, {0, 1, 2}}, 3),
            "edge (0, 1) has two faces that disagree in orientation");
}

TEST(HalfEdgeMeshBuild, RejectsTwoOpenFansAtAVertex) {
  EXPECT_EQ(build_error(shapes::bow_tie().triangles, 9), "vertex 0 has more than one fan of faces");
}

TEST(HalfEdgeMeshBuild, RejectsTwoClosedFansAtAVertex) {
  IndexedMesh two = shapes::joined(shapes::tetrahedron(), shapes::tetrahedron());
  for (Triangle& t : two.triangles) {
    for (std::uint32_t& v : t) v = v == 7 ? 0 : v;
  }
  EXPECT_EQ(build_error(two.triangles, 7), "vertex 0 has more than one fan of faces");
}

TEST(HalfEdgeMeshBuild, RejectsAClosedAndAnOpenFanAtAVertex) {
  std::vector<Triangle> triangles = shapes::tetrahedron().triangles;
  triangles.push_back({0, 4, 5});
  EXPECT_EQ(build_error(triangles, 6), "vertex 0 has more than one fan of faces");
}

TEST(HalfEdgeMeshNavigation, FindsEveryEdgeAndNoOther) {
  for (const IndexedMesh& shape : {shapes::octahedron(), shapes::grid(3, 2), shapes::hub(5)}) {
    const Result<HalfEdgeMesh> mesh = build(shape);
    ASSERT_TRUE(mesh);
    const auto count = static_cast<std::uint32_t>(shape.positions.size());
    std::vector<HalfEdgeId> expected(count * count);
    for (std::uint32_t h = 0; h < 3 * mesh->face_slots(); ++h) {
      const HalfEdgeId id(h);
      const std::uint32_t a = mesh->origin(id).value, b = mesh->target(id).value;
      expected[a * count + b] = id;
      if (mesh->is_border(id)) expected[b * count + a] = id;
    }
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = 0; b < count; ++b) {
        if (a == b) continue;
        EXPECT_EQ(mesh->find_edge(VertexId(a), VertexId(b)), expected[a * count + b]);
      }
    }
  }
}

}  // namespace
}  // namespace pmesh
