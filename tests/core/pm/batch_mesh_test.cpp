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

Fan fan_of(const SplitSite& site, const RefinableMesh& mesh) {
  Fan fan;
  fan.walk(mesh.connectivity(), site);
  return fan;
}

void apply_one(const SplitSite& site, BatchMesh& state, RefinableMesh& mesh) {
  const VertexId kept = kept_vertex(mesh.connectivity(), site);
  ASSERT_TRUE(state.apply(std::vector<BatchSplit>{{{site, {}}, kept}}, mesh).ok());
}

TEST(BatchMesh, KeepsCountAfterEveryKindOfSplit) {
  const RefinableMesh before = grid();
  const auto sites = every_site(before.connectivity());
  EXPECT_GT(sites.size(), 150u);
  for (const SplitSite& site : sites) {
    RefinableMesh mesh = before;
    BatchMesh state(mesh);
    state.cover(mesh, fan_of(site, mesh));
    apply_one(site, state, mesh);
    expect_counts(state, mesh);
  }
}

TEST(BatchMesh, CoversTheFanOrTheFaceUnderAnEar) {
  const RefinableMesh mesh = grid();
  for (const SplitSite& site : every_site(mesh.connectivity())) {
    BatchMesh state(mesh);
    state.cover(mesh, fan_of(site, mesh));
    const std::uint32_t faces = std::max<std::uint32_t>(1, site.moved_faces);
    const auto& covered = state.covered();
    EXPECT_EQ(std::accumulate(covered.begin(), covered.end(), 0u), faces);
    const VertexId kept = kept_vertex(mesh.connectivity(), site);
    EXPECT_EQ(state.free_faces(kept), state.valence(kept) - faces);
    EXPECT_FALSE(state.is_free(fan_of(site, mesh)));
  }
}

TEST(BatchMesh, UncoversOneFaceOfMany) {
  const RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  state.cover(mesh, fan_of({HalfEdgeId(0), 1, SplitKind::interior}, mesh));
  state.uncover(mesh);
  expect_counts(state, mesh);
}

TEST(BatchMesh, UncoversAll) {
  const RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  for (const SplitSite& site : every_site(mesh.connectivity())) {
    const Fan fan = fan_of(site, mesh);
    if (state.is_free(fan)) state.cover(mesh, fan);
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
    batch.push_back({{{border, 0, SplitKind::border_first}, {}}, corner, cost});
  }
  ASSERT_TRUE(state.apply(batch, mesh).ok());
  const auto order = state.order();
  EXPECT_EQ(std::vector<std::uint32_t>(order.begin(), order.end()),
            (std::vector<std::uint32_t>{3, 1, 0, 2, 4}));
}

TEST(BatchMesh, RefusesASplitThatIsNotPossible) {
  RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  const SplitSite site{HalfEdgeId(0), 200, SplitKind::interior};
  const VertexId kept = kept_vertex(mesh.connectivity(), site);
  EXPECT_FALSE(state.apply(std::vector<BatchSplit>{{{site, {}}, kept}}, mesh).ok());
}

// Ears on all border half-edges, of 50 costs.
std::vector<BatchSplit> ears(const RefinableMesh& mesh) {
  std::vector<BatchSplit> batch;
  for (VertexId v(0); v.value < mesh.vertex_count(); ++v.value) {
    if (!mesh.connectivity().is_border(v)) continue;
    const SplitSite ear{mesh.connectivity().outgoing(v), 0, SplitKind::border_first};
    batch.push_back({{ear, {}}, v, 2 * static_cast<int>(batch.size() % 50)});
  }
  return batch;
}

TEST(BatchMesh, SortsWindowsOf4096Splits) {
  RefinableMesh mesh =
      make_split_base("triangles", shapes::isolated_triangles(3000), 16, false).refinable();
  BatchMesh state(mesh);
  const std::vector<BatchSplit> batch = ears(mesh);
  ASSERT_EQ(batch.size(), 9000u);
  ASSERT_TRUE(state.apply(batch, mesh).ok());
  std::vector<std::uint32_t> expected(batch.size());
  std::iota(expected.begin(), expected.end(), 0u);
  for (std::size_t begin = 0; begin < batch.size(); begin += 4096) {
    std::stable_sort(expected.begin() + begin,
                     expected.begin() + std::min(batch.size(), begin + 4096),
                     [&](auto a, auto b) { return batch[a].cost > batch[b].cost; });
  }
  const auto order = state.order();
  EXPECT_EQ(std::vector<std::uint32_t>(order.begin(), order.end()), expected);
}

TEST(BatchMesh, NamesTheVerticesOfFewerSplitsThanOneIn32) {
  const BatchMesh state(grid());  // of 25 vertices
  EXPECT_EQ(state.order_of(0), BatchOrder::ids);
  EXPECT_EQ(state.order_of(1), BatchOrder::sweep);
  const SplitBase base = make_split_base("ball", shapes::icosphere(3), 12, false);
  const BatchMesh ball(base.refinable());  // of 642
  EXPECT_EQ(ball.order_of(20), BatchOrder::ids);
  EXPECT_EQ(ball.order_of(21), BatchOrder::sweep);
}

std::vector<std::uint32_t> values(std::span<const VertexId> vertices) {
  std::vector<std::uint32_t> values;
  for (const VertexId v : vertices) values.push_back(v.value);
  return values;
}

// An ear on the border at a vertex.
void split_at(VertexId v, BatchMesh& state, RefinableMesh& mesh) {
  apply_one({mesh.connectivity().outgoing(v), 0, SplitKind::border_first}, state, mesh);
}

RefinableMesh triangle() {
  return *RefinableMesh::from_base({{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}}});
}

TEST(BatchMesh, SweepsOverABaseById) {
  const RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  std::vector<std::uint32_t> ids(mesh.vertex_count());
  std::iota(ids.begin(), ids.end(), 0u);
  EXPECT_EQ(values(state.vertices_to_sweep()), ids);
}

TEST(BatchMesh, SweepsOverASplitVertexRightAfterItsKeptOneWhateverTheSplit) {
  const RefinableMesh before = grid();
  for (const SplitSite& site : every_site(before.connectivity())) {
    RefinableMesh mesh = before;
    BatchMesh state(mesh);
    std::vector<std::uint32_t> expected = values(state.vertices_to_sweep());
    const VertexId kept = kept_vertex(mesh.connectivity(), site);
    expected.insert(expected.begin() + kept.value + 1, before.vertex_count());
    apply_one(site, state, mesh);
    EXPECT_EQ(values(state.vertices_to_sweep()), expected);
  }
}

TEST(BatchMesh, AFamilyIsSweptByIdWhicheverOfItWasSplit) {
  RefinableMesh mesh = triangle();
  BatchMesh state(mesh);
  for (const std::uint32_t kept : {1u, 0u, 3u, 1u, 4u}) split_at(VertexId(kept), state, mesh);
  // 3, 5 and 6 are of 1's family, 4 and 7 of 0's.
  EXPECT_EQ(values(state.vertices_to_sweep()),
            (std::vector<std::uint32_t>{0, 4, 7, 1, 3, 5, 6, 2}));
}

TEST(BatchMesh, VerticesThatArriveFoundFamiliesAfterAllOthers) {
  RefinableMesh mesh = triangle();
  BatchMesh state(mesh);
  split_at(VertexId(0), state, mesh);
  ASSERT_TRUE(mesh.append(triangle().snapshot()).ok());  // 4, 5 and 6
  state.grow(mesh);
  EXPECT_EQ(values(state.vertices_to_sweep()), (std::vector<std::uint32_t>{0, 3, 1, 2, 4, 5, 6}));
  split_at(VertexId(4), state, mesh);
  split_at(VertexId(3), state, mesh);
  EXPECT_EQ(values(state.vertices_to_sweep()),
            (std::vector<std::uint32_t>{0, 3, 8, 1, 2, 4, 7, 5, 6}));
}

TEST(BatchMesh, ASweepGoesOnOverTheVerticesThatThereWereWhenItBegan) {
  RefinableMesh mesh = grid();
  BatchMesh state(mesh);
  EXPECT_TRUE(state.rest_of_sweep().empty());
  state.begin_sweep();
  state.take_off(4);
  split_at(VertexId(3), state, mesh);
  ASSERT_TRUE(mesh.append(triangle().snapshot()).ok());
  state.grow(mesh);
  std::vector<std::uint32_t> rest(21);
  std::iota(rest.begin(), rest.end(), 4u);
  EXPECT_EQ(values(state.rest_of_sweep()), rest);
  state.begin_sweep();
  EXPECT_EQ(state.rest_of_sweep().size(), 29u);
}

TEST(BatchMesh, ANewSweepTakesA64thOfNewVertices) {
  const SplitBase base = make_split_base("grid", shapes::grid(20, 20), 12, false);
  RefinableMesh mesh = base.refinable();  // of 441 vertices
  BatchMesh state(mesh);
  EXPECT_TRUE(state.may_sweep());
  state.begin_sweep();
  for (int split = 0; split < 7; ++split) {
    EXPECT_FALSE(state.may_sweep()) << split;
    EXPECT_EQ(state.order_of(100), BatchOrder::ids);
    split_at(VertexId(0), state, mesh);
  }
  EXPECT_TRUE(state.may_sweep());  // 64 * 7 = 448
  EXPECT_EQ(state.order_of(100), BatchOrder::sweep);
}

}  // namespace
}  // namespace pmesh
