// Decimation by triangle collapses, among it what the paper reports of it.
#include <cmath>

#include <gtest/gtest.h>

#include "core/decimate/decimate.h"
#include "core/io/clean.h"
#include "core/io/import.h"
#include "core/measure/compare.h"
#include "tests/core/decimate/triangle_shapes.h"
#include "tests/core/mesh/mesh_state.h"
#include "tests/fixtures/real_meshes.h"

namespace pmesh {
namespace {

DecimateOptions triangle_options(std::uint32_t base_faces) {
  DecimateOptions options;
  options.schedule = Schedule::exact;
  options.metric = TriangleCollapse();
  options.base_faces = base_faces;
  return options;
}

Decimation decimated(const IndexedMesh& mesh, std::uint32_t base_faces) {
  return decimate(half_edges(mesh), mesh.positions, triangle_options(base_faces));
}

std::vector<std::array<std::uint32_t, 4>> ids(const CollapseLog& log) {
  std::vector<std::array<std::uint32_t, 4>> rows;
  for (const HalfEdgeCollapse& c : log.collapses) {
    rows.push_back({c.removed.value, c.kept.value, c.left.value, c.right.value});
  }
  return rows;
}

class TriangleDecimation : public testing::TestWithParam<shapes::Shape> {};

TEST_P(TriangleDecimation, GoesThroughValidMeshesInStepsOfTwoCollapses) {
  const Decimation result = decimated(GetParam().mesh, 0);
  const CollapseLog& log = result.log;
  EXPECT_EQ(log.collapses_per_step, 2u);
  EXPECT_EQ(log.kept_before.size(), log.collapses.size());
  HalfEdgeMesh state = half_edges(GetParam().mesh);
  for (std::size_t i = 0; i < log.collapses.size(); ++i) {
    const auto [removed, kept, left, right] = log.collapses[i];
    EXPECT_EQ(kept, log.collapses[i / 2 * 2].kept);
    const HalfEdgeId edge = state.find_edge(removed, kept);
    ASSERT_TRUE(may_collapse(state, removed, edge));
    state.collapse(removed, edge);
    EXPECT_TRUE(state.validate());
  }
  EXPECT_EQ(state_of(state), state_of(result.mesh));
  EXPECT_EQ(result.report.faces + 2 * log.collapses.size(), GetParam().mesh.triangles.size());
}

std::size_t legal_triangles(const Decimation& result) {
  const WorkingMesh base(result.mesh, result.positions);
  std::size_t count = 0;
  for (std::uint32_t f = 0; f < result.mesh.face_slots(); ++f) {
    if (!result.mesh.is_live(FaceId(f))) continue;
    const std::optional<TriangleStar> star = star_of(base, FaceId(f));
    count += star && link_conditions_hold(*star);
  }
  return count;
}

TEST_P(TriangleDecimation, GoesAsFarAsTriangleCollapsesCan) {
  EXPECT_EQ(legal_triangles(decimated(GetParam().mesh, 0)), 0u);
}

TEST_P(TriangleDecimation, KeepsBorderVerticesInPlace) {
  const HalfEdgeMesh before = half_edges(GetParam().mesh);
  const Decimation result = decimated(GetParam().mesh, 0);
  for (std::uint32_t v = 0; v < before.vertex_slots(); ++v) {
    if (!before.is_border(VertexId(v))) continue;
    EXPECT_TRUE(result.mesh.is_live(VertexId(v)));
    EXPECT_EQ(result.positions[v], GetParam().mesh.positions[v]);
  }
}

TEST_P(TriangleDecimation, LogDoesNotDependOnTheUnit) {
  const auto expected = ids(decimated(GetParam().mesh, 4).log);
  for (const double unit : {1024.0, std::ldexp(1.0, 500), std::ldexp(1.0, -500)}) {
    IndexedMesh scaled = GetParam().mesh;
    for (Vec3d& p : scaled.positions) p = unit * p;
    EXPECT_EQ(ids(decimated(scaled, 4).log), expected) << unit;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, TriangleDecimation, testing::ValuesIn(triangle_shapes()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(TriangleDecimation, MergesTheCornersInTheirCentroid) {
  const IndexedMesh mesh = shapes::bumped(shapes::icosphere(2), 0.05);
  const Decimation result = decimated(mesh, 316);
  ASSERT_EQ(result.log.collapses.size(), 2u);
  const auto [first, second] = std::pair(result.log.collapses[0], result.log.collapses[1]);
  Vec3d sum;
  for (const VertexId v : {first.removed, second.removed, first.kept}) {
    sum += mesh.positions[v.value];
  }
  EXPECT_LT(length(result.positions[first.kept.value] - 1.0 / 3 * sum), 1e-15);
  EXPECT_EQ(result.log.kept_before[0], mesh.positions[first.kept.value]);
  EXPECT_EQ(result.log.kept_before[1], result.positions[first.kept.value]);
}

TEST(TriangleDecimation, LogDoesNotDependOnThreads) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(5), 0.05);
  DecimateOptions options = triangle_options(100);
  const auto log = ids(decimate(half_edges(sphere), sphere.positions, options).log);
  options.threads = 3;
  EXPECT_EQ(ids(decimate(half_edges(sphere), sphere.positions, options).log), log);
}

TEST(TriangleDecimation, KeepsLockedVerticesInPlace) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(3), 0.05);
  std::vector<std::uint8_t> locked(sphere.positions.size(), 0);
  for (std::size_t v = 0; v < locked.size(); v += 20) locked[v] = 1;
  DecimateOptions options = triangle_options(0);
  options.locked = locked;
  const Decimation result = decimate(half_edges(sphere), sphere.positions, options);
  EXPECT_LT(result.report.faces, sphere.triangles.size() / 2);
  for (std::uint32_t v = 0; v < locked.size(); v += 20) {
    EXPECT_TRUE(result.mesh.is_live(VertexId(v)));
    EXPECT_EQ(result.positions[v], sphere.positions[v]);
  }
}

TEST(TriangleDecimation, GivesUpThePlanarTestOnlyAtTheEndAndSaysSo) {
  const IndexedMesh sphere = shapes::icosphere(3);
  const Decimation result = decimated(sphere, 20);
  ASSERT_TRUE(result.report.planarity_relaxed_at_faces);
  const std::uint32_t last = *result.report.planarity_relaxed_at_faces;
  EXPECT_LT(result.report.faces, last);
  EXPECT_EQ(decimated(sphere, last).report.faces, last);
  EXPECT_FALSE(decimated(sphere, last).report.planarity_relaxed_at_faces);
}

TEST(TriangleDecimation, HandlesAHubWithoutQuadraticWork) {
  constexpr std::uint32_t kRim = 20'000;
  IndexedMesh disc = shapes::hub(kRim);
  for (std::uint32_t ring = 0; ring < 2; ++ring) {
    for (std::uint32_t k = 0; k < kRim; ++k) {
      disc.positions.push_back((2.0 + ring) * disc.positions[1 + k]);
      const std::uint32_t a = 1 + ring * kRim + k, b = 1 + ring * kRim + (k + 1) % kRim;
      disc.triangles.push_back({a, a + kRim, b + kRim});
      disc.triangles.push_back({a, b + kRim, b});
    }
  }
  EXPECT_LT(decimated(disc, 0).report.faces, disc.triangles.size());
}

struct Function {
  std::string name;
  shapes::Height height;
};

// Section 4 of the paper: functions over a grid of 11 x 11 vertices and 200 triangles.
class TrianglePaperFunction : public testing::TestWithParam<Function> {
 protected:
  IndexedMesh mesh_ = shapes::grid(10, 10, GetParam().height);
};

TEST_P(TrianglePaperFunction, ComesToTheTrianglesAndVerticesOfItsTableWithEveryTest) {
  for (const auto& [faces, vertices] : {std::pair(196u, 119u), std::pair(180u, 111u)}) {
    const DecimationReport report = decimated(mesh_, faces).report;
    EXPECT_EQ(report.faces, faces);
    EXPECT_EQ(report.vertices, vertices);
    EXPECT_FALSE(report.planarity_relaxed_at_faces);
    EXPECT_FALSE(report.fold_over_relaxed_at_faces);
  }
}

// The table has 142 triangles, which is impossible: a disc of 91 vertices, 40 of them on its
// border, has 140.
TEST_P(TrianglePaperFunction, ComesToTheVerticesOfItsTablesLastRow) {
  const DecimationReport report = decimated(mesh_, 140).report;
  EXPECT_EQ(report.faces, 140u);
  EXPECT_EQ(report.vertices, 91u);
}

TEST_P(TrianglePaperFunction, FoldsNoFaceOverAsSeenFromAbove) {
  const Decimation result = decimated(mesh_, 140);
  const LiveMesh live = result.mesh.live();
  for (const Triangle& t : live.triangles) {
    const auto at = [&](std::uint32_t v) { return result.positions[live.vertices[v].value]; };
    EXPECT_GT(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])).z, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, TrianglePaperFunction,
                         testing::Values(Function{"Cosine",
                                                  [](double x, double y) {
                                                    return (1.25 + std::cos(5.4 * y)) /
                                                           (6 + 6 * (3 * x - 1) * (3 * x - 1));
                                                  }},
                                         Function{"Exponential",
                                                  [](double x, double y) {
                                                    const double u = x - 0.5, v = y - 0.5;
                                                    return std::exp(-81.0 / 4 * (u * u + v * v)) /
                                                           3;
                                                  }},
                                         Function{"Bump",
                                                  [](double x, double y) {
                                                    return std::sin(5 * x) * std::cos(5 * y) / 5;
                                                  }}),
                         [](const auto& parameter) { return parameter.param.name; });

IndexedMesh base_of(const Decimation& result) {
  LiveMesh live = result.mesh.live();
  IndexedMesh base;
  for (const VertexId v : live.vertices) base.positions.push_back(result.positions[v.value]);
  base.triangles = std::move(live.triangles);
  return base;
}

TEST(TriangleDecimation, KeepsFandiskWithinAThousandthOfItsDiagonalAtHalfItsFaces) {
  PMESH_NEED_REAL_MESH(path, "fandisk.obj");
  const IndexedMesh mesh = clean(*import_mesh(path)).mesh;
  const Decimation result = decimated(mesh, static_cast<std::uint32_t>(mesh.triangles.size() / 2));
  EXPECT_FALSE(result.report.planarity_relaxed_at_faces);
  CompareOptions options;
  options.samples = 100'000;
  const Result<Comparison> error = compare_surfaces(mesh, base_of(result), options);
  ASSERT_TRUE(error);
  EXPECT_LT(error->max(), 0.001 * error->bbox_diagonal);
}

TEST(TriangleDecimation, BringsTheHorseToHalfAPercent) {
  PMESH_NEED_REAL_MESH(path, "horse.ply");
  const IndexedMesh mesh = clean(*import_mesh(path)).mesh;
  EXPECT_LE(decimated(mesh, 0).report.faces, mesh.triangles.size() / 200);
}

}  // namespace
}  // namespace pmesh
