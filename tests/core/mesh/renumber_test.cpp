#include <gtest/gtest.h>

#include "core/mesh/half_edge_mesh.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/core/mesh/mesh_state.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

// A mesh with dead slots: every third vertex is removed that can be.
HalfEdgeMesh with_gaps(const IndexedMesh& shape) {
  HalfEdgeMesh mesh =
      HalfEdgeMesh::build(shape.triangles, static_cast<std::uint32_t>(shape.positions.size()))
          .value();
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); v += 3) {
    if (!mesh.is_live(VertexId(v))) continue;
    const HalfEdgeId edge = mesh.outgoing(VertexId(v));
    if (may_collapse(mesh, VertexId(v), edge)) mesh.collapse(VertexId(v), edge);
  }
  return mesh;
}

TEST(Renumber, CompactMeshesAreTheLivePartInItsOrder) {
  for (const IndexedMesh& shape : {shapes::icosphere(3), shapes::grid(9, 7)}) {
    HalfEdgeMesh mesh = with_gaps(shape);
    const LiveMesh live = mesh.live();
    const CompactIds ids = mesh.compact();
    EXPECT_TRUE(mesh.validate());
    EXPECT_EQ(mesh.live().triangles, live.triangles);
    EXPECT_EQ(mesh.vertex_slots(), mesh.live_vertices());
    EXPECT_EQ(mesh.face_slots(), mesh.live_faces());
    EXPECT_EQ(ids.vertices, live.vertices);
    EXPECT_EQ(ids.faces, live.faces);
    for (std::uint32_t v = 0; v < ids.vertices.size(); ++v) {
      EXPECT_EQ(ids.new_vertices[ids.vertices[v].value], VertexId(v));
    }
  }
}

TEST(Renumber, SpreadingUndoesIt) {
  HalfEdgeMesh mesh = with_gaps(shapes::grid(9, 7));
  const MeshState before = state_of(mesh);
  const std::uint32_t vertices = mesh.vertex_slots(), faces = mesh.face_slots();
  const CompactIds ids = mesh.compact();
  mesh.spread(ids.vertices, ids.faces, vertices, faces);
  EXPECT_TRUE(mesh.validate());
  EXPECT_EQ(state_of(mesh), before);
}

TEST(CloseUp, MovesWhatIsStored) {
  std::vector<int> stored{10, 11, 12, 13};
  close_up(stored, std::vector<VertexId>{VertexId(1), VertexId(3)});
  EXPECT_EQ(stored, (std::vector<int>{11, 13}));
}

}  // namespace
}  // namespace pmesh
