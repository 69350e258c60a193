#include "core/decimate/decimate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "core/decimate/legality.h"
#include "tests/core/decimate/rings.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/core/mesh/mesh_state.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

Decimation decimated(const IndexedMesh& mesh, std::uint32_t base_faces, Schedule schedule,
                     unsigned threads = 1) {
  DecimateOptions options;
  options.schedule = schedule;
  options.base_faces = base_faces;
  options.threads = threads;
  return decimate(half_edges(mesh), mesh.positions, options);
}

std::vector<std::array<std::uint32_t, 4>> ids(const CollapseLog& log) {
  std::vector<std::array<std::uint32_t, 4>> rows;
  for (const HalfEdgeCollapse& c : log.collapses) {
    rows.push_back({c.removed.value, c.kept.value, c.left.value, c.right.value});
  }
  return rows;
}

std::size_t legal_collapses(const HalfEdgeMesh& mesh) {
  std::size_t count = 0;
  for (std::uint32_t h = 0; h < mesh.corners().size(); ++h) {
    if (!mesh.is_live(HalfEdgeMesh::face(HalfEdgeId(h)))) continue;
    count += may_collapse(mesh, mesh.origin(HalfEdgeId(h)), HalfEdgeId(h));
    count += may_collapse(mesh, mesh.target(HalfEdgeId(h)), HalfEdgeId(h));
  }
  return count;
}

// The mesh that the log gives from `mesh`, its states (of large meshes only some) validated.
HalfEdgeMesh replayed(const IndexedMesh& mesh, const CollapseLog& log) {
  HalfEdgeMesh state = half_edges(mesh);
  const std::size_t stride = 1 + mesh.triangles.size() / 1000;
  for (std::size_t i = 0; i < log.collapses.size(); ++i) {
    const HalfEdgeCollapse& logged = log.collapses[i];
    const HalfEdgeId edge = state.find_edge(logged.removed, logged.kept);
    EXPECT_TRUE(may_collapse(state, logged.removed, edge));
    const HalfEdgeCollapse done = state.collapse(logged.removed, edge);
    EXPECT_EQ(done.left, logged.left);
    EXPECT_EQ(done.right, logged.right);
    EXPECT_TRUE(i % stride != 0 || state.validate());
  }
  return state;
}

std::string name_of(Schedule schedule) {
  return schedule == Schedule::batched ? "Batched" : "Exact";
}

class DecimateShape : public testing::TestWithParam<std::tuple<shapes::Shape, Schedule>> {
 protected:
  const IndexedMesh& input() const { return std::get<0>(GetParam()).mesh; }
  Decimation decimated_to(std::uint32_t base_faces) const { return decimated(input(), base_faces); }
  Decimation decimated(const IndexedMesh& mesh, std::uint32_t base_faces) const {
    return pmesh::decimated(mesh, base_faces, std::get<1>(GetParam()));
  }
};

TEST_P(DecimateShape, GoesAsFarAsTopologyAllows) {
  const Decimation result = decimated_to(0);
  EXPECT_TRUE(result.mesh.validate());
  EXPECT_EQ(legal_collapses(result.mesh), 0u);
  EXPECT_EQ(result.report.faces, result.mesh.live_faces());
  EXPECT_EQ(result.report.vertices + result.log.collapses.size(), input().positions.size());
}

TEST_P(DecimateShape, LogReplaysThroughValidMeshesToTheBase) {
  const Decimation result = decimated_to(4);
  EXPECT_EQ(state_of(replayed(input(), result.log)), state_of(result.mesh));
}

TEST_P(DecimateShape, LogBackwardsRebuildsTheInput) {
  const IndexedMesh& input = this->input();
  const Decimation result = decimated_to(4);
  std::vector<std::uint32_t> old_ids, new_ids(input.positions.size());
  const auto rename = [&](std::uint32_t v) {
    new_ids[v] = static_cast<std::uint32_t>(old_ids.size());
    old_ids.push_back(v);
  };
  for (std::uint32_t v = 0; v < input.positions.size(); ++v) {
    if (result.mesh.is_live(VertexId(v))) rename(v);
  }
  IndexedMesh base{std::vector<Vec3d>(old_ids.size()), {}};
  for (std::uint32_t f = 0; f < result.mesh.face_slots(); ++f) {
    const auto t = result.mesh.corners().subspan(std::size_t{3} * f, 3);
    if (!t[0].valid()) continue;
    base.triangles.push_back({new_ids[t[0].value], new_ids[t[1].value], new_ids[t[2].value]});
  }
  HalfEdgeMesh mesh = half_edges(base);
  const auto renamed = [&](VertexId v) { return v.valid() ? VertexId(new_ids[v.value]) : v; };
  const auto& log = result.log.collapses;
  std::for_each(log.rbegin(), log.rend(), [&](const HalfEdgeCollapse& c) {
    const VertexId kept = renamed(c.kept), left = renamed(c.left), right = renamed(c.right);
    mesh.split(mesh.find_site({VertexId(), kept, left, right}));
    rename(c.removed.value);
  });
  std::vector<Triangle> triangles(mesh.face_slots());
  for (std::uint32_t h = 0; h < mesh.corners().size(); ++h) {
    triangles[h / 3][h % 3] = old_ids[mesh.corners()[h].value];
  }
  EXPECT_EQ(sorted_triangles(triangles), sorted_triangles(input.triangles));
}

TEST_P(DecimateShape, LogDoesNotDependOnTheUnit) {
  const auto expected = ids(decimated_to(4).log);
  for (const double unit : {1024.0, std::ldexp(1.0, 520), std::ldexp(1.0, -560)}) {
    IndexedMesh scaled = input();
    for (Vec3d& p : scaled.positions) p = unit * p;
    EXPECT_EQ(ids(decimated(scaled, 4).log), expected) << unit;
  }
}

TEST_P(DecimateShape, FarFromTheOriginGoesAsFar) {
  const IndexedMesh far = shapes::moved(input(), {5e6, 5e6, 0});
  const Decimation result = decimated(far, 0);
  EXPECT_TRUE(result.mesh.validate());
  EXPECT_EQ(legal_collapses(result.mesh), 0u);
}

std::string case_name(const testing::TestParamInfo<std::tuple<shapes::Shape, Schedule>>& info) {
  return std::get<0>(info.param).name + name_of(std::get<1>(info.param));
}

INSTANTIATE_TEST_SUITE_P(Shapes, DecimateShape,
                         testing::Combine(testing::ValuesIn(shapes::manifolds()),
                                          testing::Values(Schedule::batched, Schedule::exact)),
                         case_name);

class Decimate : public testing::TestWithParam<Schedule> {
 protected:
  static Decimation decimated(const IndexedMesh& mesh, std::uint32_t base_faces,
                              unsigned threads = 1) {
    return pmesh::decimated(mesh, base_faces, GetParam(), threads);
  }
};

INSTANTIATE_TEST_SUITE_P(Schedules, Decimate, testing::Values(Schedule::batched, Schedule::exact),
                         [](const auto& parameter) { return name_of(parameter.param); });

TEST_P(Decimate, StopsAtTheFirstMeshThatIsSmallEnough) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(3), 0.05);
  EXPECT_EQ(decimated(sphere, 200).report.faces, 200u);
  EXPECT_EQ(decimated(sphere, 201).report.faces, 200u);
  EXPECT_TRUE(decimated(sphere, 5000).log.collapses.empty());
}

TEST_P(Decimate, ReachesTheFloorOfEveryTopology) {
  EXPECT_EQ(decimated(shapes::icosphere(2), 0).report.faces, 4u);
  EXPECT_EQ(decimated(shapes::grid(9, 9), 0).report.faces, 1u);
  EXPECT_EQ(decimated(shapes::isolated_triangles(20), 0).report.faces, 20u);
  EXPECT_LE(decimated(shapes::torus(24, 12), 0).report.faces, 20u);
}

TEST_P(Decimate, LogDoesNotDependOnThreads) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(5), 0.05);  // three blocks of work
  const auto log = ids(decimated(sphere, 4, 1).log);
  EXPECT_EQ(ids(decimated(sphere, 4, 2).log), log);
  EXPECT_EQ(ids(decimated(sphere, 4, 3).log), log);
}

TEST_P(Decimate, KeepsLockedVertices) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(3), 0.05);
  std::vector<std::uint8_t> locked(sphere.positions.size(), 0);
  for (std::size_t v = 0; v < locked.size(); v += 10) locked[v] = 1;
  DecimateOptions options;
  options.schedule = GetParam();
  options.base_faces = 0;
  options.locked = locked;
  const Decimation result = decimate(half_edges(sphere), sphere.positions, options);
  EXPECT_LT(result.report.faces, sphere.triangles.size() / 4);
  for (std::uint32_t v = 0; v < locked.size(); v += 10)
    EXPECT_TRUE(result.mesh.is_live(VertexId(v)));
}

TEST_P(Decimate, NoFaceOfAGridTurnsOver) {
  const IndexedMesh flat = shapes::grid(20, 20);
  const Decimation result = decimated(flat, 30);
  EXPECT_FALSE(result.report.fold_over_relaxed_at_faces);
  for (std::uint32_t f = 0; f < result.mesh.face_slots(); ++f) {
    const auto t = result.mesh.corners().subspan(std::size_t{3} * f, 3);
    if (!t[0].valid()) continue;
    const Vec3d a = flat.positions[t[0].value];
    const Vec3d n = cross(flat.positions[t[1].value] - a, flat.positions[t[2].value] - a);
    EXPECT_GE(n.z, 0);
  }
}

TEST_P(Decimate, RelaxesTheFoldOverCheckOnlyAtTheEndAndSaysSo) {
  const IndexedMesh mesh = shapes::bumped(shapes::genus(20), 0.3);
  const Decimation result = decimated(mesh, 0);
  ASSERT_TRUE(result.report.fold_over_relaxed_at_faces);
  EXPECT_LT(result.report.faces, *result.report.fold_over_relaxed_at_faces);
  const std::uint32_t above = 2 * *result.report.fold_over_relaxed_at_faces;
  EXPECT_FALSE(decimated(mesh, above).report.fold_over_relaxed_at_faces);
}

TEST_P(Decimate, HandlesAHubWithoutQuadraticWork) {
  EXPECT_EQ(decimated(shapes::hub(100'000), 0).report.faces, 1u);
}

TEST_P(Decimate, HandlesAHubOnABorderWithoutQuadraticWork) {
  constexpr std::uint32_t kRim = 100'000;
  IndexedMesh fan{{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < kRim; ++i) {
    fan.positions.push_back({std::cos(3.0 * i / kRim), std::sin(3.0 * i / kRim), 0.01 * (i % 7)});
    if (i > 0) fan.triangles.push_back({0, i, i + 1});
  }
  EXPECT_EQ(decimated(fan, 0).report.faces, 1u);
}

TEST_P(Decimate, ReportsProgress) {
  const IndexedMesh sphere = shapes::icosphere(6);  // 40,962 vertices
  DecimateOptions options;
  options.schedule = GetParam();
  std::vector<std::uint64_t> seen;
  options.progress = [&](std::uint64_t done, std::uint64_t guess) {
    EXPECT_LE(done, guess);
    seen.push_back(done);
  };
  static_cast<void>(decimate(half_edges(sphere), sphere.positions, options));
  EXPECT_GE(seen.size(), 2u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
}

}  // namespace
}  // namespace pmesh
