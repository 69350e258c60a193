#include "core/pm/batch_mesh.h"

#include <numeric>

#include <gtest/gtest.h>

#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

RefinableMesh grid() { return make_split_base("grid", shapes::grid(4, 4), 10, false).refinable(); }

std::vector<std::uint32_t> count_valences(const RefinableMesh& mesh) {
  std::vector<std::uint32_t> valences(mesh.vertex_count());
  for (const VertexId v : mesh.corners()) ++valences[v.value];
  return valences;
}

void expect_counts(const BatchMesh& state, const RefinableMesh& mesh) {
  const auto valences = count_valences(mesh);
  for (VertexId v(0); v.value < mesh.vertex_count(); ++v.value) {
    EXPECT_EQ(state.valence(v), valences[v.value]) << v.value;
    EXPECT_EQ(state.free_faces(v), valences[v.value]) << v.value;
  }
  for (FaceId f(0); f.value < mesh.face_count(); ++f.value) EXPECT_TRUE(state.is_free(f));
}

TEST(BatchMesh, CountsTheFacesOfABase) {
  const RefinableMesh mesh = grid();
  expect_counts(BatchMesh(mesh), mesh);
}

// The last outgoing half-edge of a border vertex's fan, and the incoming one beside it.
HalfEdgeId last_incoming(const HalfEdgeMesh& mesh, VertexId v) {
  HalfEdgeId last = mesh.outgoing(v);
  for (HalfEdgeId h = last; h.valid(); h = mesh.rotate_ccw(h)) last = h;
  return HalfEdgeMesh::prev(last);
}

// All sites of every vertex that move up to three faces.
std::vector<SplitSite> every_site(const HalfEdgeMesh& mesh) {
  std::vector<SplitSite> sites;
  for (VertexId v(0); v.value < mesh.live_vertices(); ++v.value) {
    for (std::uint16_t moved = 0; moved <= 3; ++moved) {
      sites.push_back({mesh.outgoing(v), moved, SplitKind::interior});
      if (!mesh.is_border(v)) continue;
      sites.push_back({mesh.outgoing(v), moved, SplitKind::border_first});
      sites.push_back({last_incoming(mesh, v), moved, SplitKind::border_last});
    }
  }
  std::erase_if(sites, [&](const SplitSite& site) { return !mesh.check(site).ok(); });
  return sites;
}

TEST(BatchMesh, KeepsCountAfterEveryKindOfSplit) {
  const RefinableMesh before = grid();
  const auto sites = every_site(before.connectivity());
  EXPECT_GT(sites.size(), 150u);
  for (const SplitSite& site : sites) {
    RefinableMesh mesh = before;
    BatchMesh state(mesh);
    state.cover(mesh, site);
    ASSERT_TRUE(state.apply(std::vector<BatchSplit>{{{site, {}}}}, mesh).ok());
    expect_counts(state, mesh);
  }
}

TEST(BatchMesh, CoversTheFanOrTheFaceUnderAnEar) {
  const RefinableMesh mesh = grid();
  for (const SplitSite& site : every_site(mesh.connectivity())) {
    BatchMesh state(mesh);
    state.cover(mesh, site);
    const std::uint32_t faces = std::max<std::uint32_t>(1, site.moved_faces);
    const auto& covered = state.covered();
    EXPECT_EQ(std::accumulate(covered.begin(), covered.end(), 0u), faces);
    const VertexId kept = kept_vertex(mesh.connectivity(), site);
    EXPECT_EQ(state.free_faces(kept), state.valence(kept) - faces);
  }
}

TEST(BatchMesh, UncoversAll) {
  const RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  for (const SplitSite& site : every_site(mesh.connectivity())) {
    if (!state.is_free(HalfEdgeMesh::face(site.half_edge)) || site.moved_faces > 1) continue;
    state.cover(mesh, site);
  }
  state.uncover(mesh);
  expect_counts(state, mesh);
}

TEST(BatchMesh, AppliesTheDearestFirstAndEqualOnesInTheirOrder) {
  RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  std::vector<BatchSplit> batch;
  for (const int cost : {10, 90, 10, 500, -7}) {  // ears on other borders
    const VertexId corner(static_cast<std::uint32_t>(batch.size()));
    const HalfEdgeId border = mesh.connectivity().outgoing(corner);
    batch.push_back({{{border, 0, SplitKind::border_first}, {}}, cost});
  }
  ASSERT_TRUE(state.apply(batch, mesh).ok());
  const auto order = state.order();
  EXPECT_EQ(std::vector<std::uint32_t>(order.begin(), order.end()),
            (std::vector<std::uint32_t>{3, 1, 0, 2, 4}));
}

TEST(BatchMesh, RefusesASplitThatIsNotPossible) {
  RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  const std::vector<BatchSplit> batch = {{{{HalfEdgeId(0), 200, SplitKind::interior}, {}}}};
  EXPECT_FALSE(state.apply(batch, mesh).ok());
}

}  // namespace
}  // namespace pmesh
