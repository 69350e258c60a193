// HalfEdgeMesh::check(), the rule that stands between hostile bytes and the mesh: on small meshes
// every site there is, and every impossible one.
#include <gtest/gtest.h>

#include "core/mesh/half_edge_mesh.h"
#include "tests/core/mesh/mesh_state.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

constexpr std::uint16_t kMostMoved = 8;

std::vector<shapes::Shape> small_manifolds() {
  return {{"Tetrahedron", shapes::tetrahedron()},
          {"Octahedron", shapes::octahedron()},
          {"Torus", shapes::torus(4, 3)},
          {"Grid", shapes::grid(3, 2)},
          {"Ears", shapes::grid_with_ears(2)},
          {"Hub", shapes::hub(5)},
          {"Strip", shapes::grid(3, 1)},
          {"Triangles", shapes::isolated_triangles(2)},
          {"Pieces", shapes::components(3)},
          {"TwoSidedTriangle", {{{}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}}};
}

HalfEdgeMesh built(const IndexedMesh& mesh) {
  return HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()))
      .value();
}

std::vector<SplitSite> all_sites(const HalfEdgeMesh& mesh) {
  std::vector<SplitSite> sites;
  for (std::uint32_t h = 0; h < mesh.corners().size(); ++h) {
    for (std::uint16_t moved = 0; moved <= kMostMoved; ++moved) {
      for (const SplitKind kind :
           {SplitKind::interior, SplitKind::border_first, SplitKind::border_last}) {
        sites.push_back({HalfEdgeId(h), moved, kind});
      }
    }
  }
  return sites;
}

// How many sites a mesh has, from valences alone. A fan of d faces has d (d - 1) proper arcs if it
// is closed; if open, d (d + 1) / 2 arcs, and at each end 0 to d faces to take over.
std::size_t expected_site_count(const HalfEdgeMesh& mesh) {
  std::vector<std::size_t> valence(mesh.vertex_slots(), 0);
  for (const VertexId v : mesh.corners()) ++valence[v.value];
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    const std::size_t d = valence[v];
    EXPECT_LE(d, kMostMoved);
    count += mesh.is_border(VertexId(v)) ? d * (d + 1) / 2 + 2 * (d + 1) : d * (d - 1);
  }
  return count;
}

class OnSmallMeshes : public testing::TestWithParam<shapes::Shape> {};

TEST_P(OnSmallMeshes, EverySiteThatPassesSplitsToAManifoldAndBack) {
  const HalfEdgeMesh whole = built(GetParam().mesh);
  for (const SplitSite& site : all_sites(whole)) {
    if (!whole.check(site)) continue;
    HalfEdgeMesh mesh = whole;
    mesh.split(site);
    const Status status = mesh.validate();
    ASSERT_TRUE(status) << status.error().message;
    ASSERT_EQ(mesh.live_faces(), whole.live_faces() + site.added_faces());
    mesh.undo_split(site);
    ASSERT_EQ(state_of(mesh), state_of(whole));
    ASSERT_TRUE(mesh.validate());
  }
}

TEST_P(OnSmallMeshes, ExactlyThePossibleSitesPass) {
  const HalfEdgeMesh mesh = built(GetParam().mesh);
  std::size_t count = 0;
  for (const SplitSite& site : all_sites(mesh)) count += mesh.check(site) ? 1 : 0;
  EXPECT_EQ(count, expected_site_count(mesh));
}

TEST_P(OnSmallMeshes, EverySiteIsFoundFromItsCollapse) {
  const HalfEdgeMesh whole = built(GetParam().mesh);
  for (const SplitSite& site : all_sites(whole)) {
    if (!whole.check(site)) continue;
    HalfEdgeMesh mesh = whole;
    const VertexId kept = mesh.split(site);
    const VertexId added(mesh.vertex_slots() - 1);
    const HalfEdgeCollapse done = mesh.collapse(added, mesh.find_edge(added, kept));
    EXPECT_EQ(whole.find_site(done), site);
  }
}

INSTANTIATE_TEST_SUITE_P(HalfEdgeMeshCheck, OnSmallMeshes, testing::ValuesIn(small_manifolds()),
                         [](const auto& shape) { return shape.param.name; });

TEST(HalfEdgeMeshCheck, RejectsHalfEdgesThatDoNotExist) {
  const HalfEdgeMesh mesh = built(shapes::octahedron());
  for (const std::uint32_t h : {24u, 25u, kNoIndex - 1, kNoIndex}) {
    for (const SplitKind kind :
         {SplitKind::interior, SplitKind::border_first, SplitKind::border_last}) {
      EXPECT_FALSE(mesh.check({HalfEdgeId(h), 1, kind}));
    }
  }
  EXPECT_FALSE(HalfEdgeMesh().check({HalfEdgeId(0), 1, SplitKind::interior}));
}

TEST(HalfEdgeMeshCheck, SaysWhatIsWrong) {
  const HalfEdgeMesh mesh = built(shapes::octahedron());
  const auto complaint = [&](SplitSite site) { return mesh.check(site).error().message; };
  EXPECT_EQ(complaint({HalfEdgeId(0), 0, SplitKind::interior}), "an interior split moves no face");
  EXPECT_EQ(complaint({HalfEdgeId(0), 4, SplitKind::interior}),
            "the split's cut neighbours are the same");
  EXPECT_EQ(complaint({HalfEdgeId(0), 65535, SplitKind::interior}),
            "the split moves more faces than there are");
  EXPECT_EQ(complaint({HalfEdgeId(0), 0, SplitKind::border_last}),
            "a border split is not at a border");
}

}  // namespace
}  // namespace pmesh
