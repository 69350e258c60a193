// What the codec relies on: the steps of a batch do not meet, and they are logged in the order of
// their keys.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "core/decimate/batch_elements.h"
#include "core/decimate/batch_keys.h"
#include "core/decimate/decimate.h"
#include "core/decimate/one_ring.h"
#include "tests/core/decimate/rings.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/core/mesh/mesh_state.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

Decimation batched(const IndexedMesh& mesh, const AnyMetric& metric, std::uint32_t base_faces,
                   unsigned threads = 1) {
  DecimateOptions options;
  options.metric = metric;
  options.base_faces = base_faces;
  options.threads = threads;
  return decimate(half_edges(mesh), mesh.positions, options);
}

// Calls visit(batch) for the collapses of each batch of the log.
template <class Visit>
void for_each_batch(const CollapseLog& log, const Visit& visit) {
  std::span<const HalfEdgeCollapse> rest = log.collapses;
  std::uint32_t begin = 0;
  for (const std::uint32_t end : log.batch_ends) {
    ASSERT_GT(end, begin);
    visit(rest.first(end - begin));
    rest = rest.subspan(end - begin);
    begin = end;
  }
  EXPECT_TRUE(rest.empty());
}

void replay(HalfEdgeMesh& mesh, const HalfEdgeCollapse& c) {
  const HalfEdgeId edge = mesh.find_edge(c.removed, c.kept);
  ASSERT_TRUE(may_collapse(mesh, c.removed, edge));
  const HalfEdgeCollapse done = mesh.collapse(c.removed, edge);
  EXPECT_EQ(std::tie(done.left, done.right), std::tie(c.left, c.right));
}

// By removed vertex, the number of its step.
std::map<VertexId, std::size_t> steps_of(std::span<const HalfEdgeCollapse> batch,
                                         std::uint32_t per_step) {
  std::map<VertexId, std::size_t> steps;
  for (std::size_t i = 0; i < batch.size(); ++i) steps[batch[i].removed] = i / per_step;
  return steps;
}

bool has_face_of_two_steps(const HalfEdgeMesh& mesh, const std::map<VertexId, std::size_t>& steps) {
  for (std::uint32_t f = 0; f < mesh.face_slots(); ++f) {
    std::set<std::size_t> met;
    for (const VertexId v : mesh.corners().subspan(std::size_t{3} * f, 3)) {
      if (const auto found = steps.find(v); found != steps.end()) met.insert(found->second);
    }
    if (met.size() > 1) return true;
  }
  return false;
}

bool keeps_a_vertex_twice(std::span<const HalfEdgeCollapse> batch, std::uint32_t per_step,
                          const std::map<VertexId, std::size_t>& steps) {
  std::set<VertexId> kept;
  for (std::size_t i = 0; i < batch.size(); i += per_step) {
    if (!kept.insert(batch[i].kept).second || steps.contains(batch[i].kept)) return true;
  }
  return false;
}

using Case = std::tuple<shapes::Shape, std::pair<std::string, std::string>>;

class Batches : public testing::TestWithParam<Case> {
 protected:
  const IndexedMesh& input() const { return std::get<0>(GetParam()).mesh; }
  Decimation result(std::uint32_t base_faces, unsigned threads = 1) const {
    const auto& [name, parameters] = std::get<1>(GetParam());
    return batched(input(), *make_metric(name, parameters), base_faces, threads);
  }
};

TEST_P(Batches, AreOfStepsThatDoNotMeet) {
  const CollapseLog log = result(4).log;
  HalfEdgeMesh mesh = half_edges(input());
  for_each_batch(log, [&](std::span<const HalfEdgeCollapse> batch) {
    EXPECT_EQ(batch.size() % log.collapses_per_step, 0u);
    const auto steps = steps_of(batch, log.collapses_per_step);
    EXPECT_FALSE(has_face_of_two_steps(mesh, steps));
    EXPECT_FALSE(keeps_a_vertex_twice(batch, log.collapses_per_step, steps));
    for (const HalfEdgeCollapse& c : batch) replay(mesh, c);
  });
}

TEST_P(Batches, MayBeCollapsedInAnyOrderOfTheirSteps) {
  const Decimation decimation = result(4);
  const std::uint32_t per_step = decimation.log.collapses_per_step;
  HalfEdgeMesh mesh = half_edges(input());
  for_each_batch(decimation.log, [&](std::span<const HalfEdgeCollapse> batch) {
    for (std::size_t end = batch.size(); end > 0; end -= per_step) {
      for (const HalfEdgeCollapse& c : batch.subspan(end - per_step, per_step)) replay(mesh, c);
    }
  });
  EXPECT_EQ(state_of(mesh), state_of(decimation.mesh));
}

TEST_P(Batches, GoNoLessFarThanTheExactOrder) {
  DecimateOptions options;
  const auto& [name, parameters] = std::get<1>(GetParam());
  options.metric = *make_metric(name, parameters);
  options.schedule = Schedule::exact;
  const Decimation exact = decimate(half_edges(input()), input().positions, options);
  const Decimation decimation = result(options.base_faces);
  EXPECT_TRUE(decimation.mesh.validate());
  EXPECT_LE(decimation.report.faces, std::max(exact.report.faces, options.base_faces));
}

// Undone from the end, relocations lead back to the input.
TEST_P(Batches, LogWhereKeptVerticesWere) {
  const Decimation decimation = result(4);
  std::vector<Vec3d> positions = decimation.positions;
  for (std::size_t i = decimation.log.kept_before.size(); i-- > 0;) {
    positions[decimation.log.collapses[i].kept.value] = decimation.log.kept_before[i];
  }
  EXPECT_EQ(positions, input().positions);
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  const auto& [shape, metric] = info.param;
  std::string name = shape.name + "_" + metric.first + (metric.second.empty() ? "" : "Solved");
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, Batches,
    testing::Combine(
        testing::Values(shapes::Shape{"Icosphere", shapes::icosphere(3)},
                        shapes::Shape{"BumpedIcosphere", shapes::bumped(shapes::icosphere(3), .1)},
                        shapes::Shape{"Torus", shapes::bumped(shapes::torus(24, 12), 0.05)},
                        shapes::Shape{"ThinTorus", shapes::bumped(shapes::torus(30, 4), 0.02)},
                        shapes::Shape{"Genus", shapes::bumped(shapes::genus(3), 0.1)},
                        shapes::Shape{"Grid", shapes::grid(15, 15)},
                        shapes::Shape{"GridWithEars", shapes::grid_with_ears(6)},
                        shapes::Shape{"Components", shapes::components(12)},
                        shapes::Shape{"LatticeDegenerate", shapes::lattice_degenerate(12)}),
        testing::Values(std::pair("blended-qem", ""), std::pair("melod", ""), std::pair("qem", ""),
                        std::pair("qem", "placement=solved"), std::pair("memoryless", ""),
                        std::pair("feature-sensitive", ""), std::pair("triangle", ""))),
    case_name);

TEST(Batch, ListsItsStepsInTheOrderOfTheirKeys) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(4), 0.05);
  const BlendedQem metric(0);  // remembers nothing: the ring says all
  const Decimation decimation = batched(sphere, metric, 50);
  WorkingMesh work(half_edges(sphere), sphere.positions);
  BlendedQem started = metric;
  started.start(work.mesh(), work.positions(), work.frame());
  for_each_batch(decimation.log, [&](std::span<const HalfEdgeCollapse> batch) {
    std::vector<float> keys;
    OneRing ring;
    for (const HalfEdgeCollapse& c : batch) {
      ASSERT_TRUE(gather_neighbours(work.mesh(), c.removed, ring));
      gather_positions(work, ring);
      gather_faces(ring);
      const double cost = started.cost(ring, started.prepare(ring), ring.index_of(c.kept), {});
      keys.push_back(batch_key(cost));
    }
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
    for (const HalfEdgeCollapse& c : batch) {
      work.collapse(c.removed, work.mesh().find_edge(c.removed, c.kept));
    }
  });
}

TEST(Batch, IsLargeWhereThereIsRoom) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(4), 0.05);
  const CollapseLog log = batched(sphere, BlendedQem(), 50).log;
  EXPECT_GT(log.batch_ends.front(), sphere.positions.size() * 15 / 100);
}

TEST(Batch, DoesNotDependOnThreads) {
  const IndexedMesh sphere = shapes::bumped(shapes::icosphere(5), 0.05);  // three blocks of work
  for (const char* name : {"blended-qem", "melod", "memoryless", "triangle"}) {
    const CollapseLog one = batched(sphere, *make_metric(name), 100, 1).log;
    for (const unsigned threads : {2u, 3u}) {
      const CollapseLog log = batched(sphere, *make_metric(name), 100, threads).log;
      EXPECT_EQ(log.batch_ends, one.batch_ends) << name;
      EXPECT_EQ(log.kept_before, one.kept_before) << name;
      const auto same = [](const HalfEdgeCollapse& a, const HalfEdgeCollapse& b) {
        return a.removed == b.removed && a.kept == b.kept;
      };
      EXPECT_TRUE(std::ranges::equal(log.collapses, one.collapses, same)) << name;
    }
  }
}

// Handles make vertices few beside the faces that must go.
TEST(Batch, StopsAtTheTargetWhateverTheGenus) {
  const IndexedMesh plate = shapes::bumped(shapes::genus(60), 0.1);
  const auto faces = static_cast<std::uint32_t>(plate.triangles.size());
  for (std::uint32_t base_faces = faces / 10; base_faces < faces; base_faces += faces / 10) {
    const Decimation decimation = batched(plate, BlendedQem(), base_faces, 2);
    EXPECT_LE(decimation.report.faces, base_faces);
    EXPECT_GE(decimation.report.faces + 1, base_faces);
    HalfEdgeMesh mesh = half_edges(plate);
    for (const HalfEdgeCollapse& c : decimation.log.collapses) replay(mesh, c);
    EXPECT_EQ(state_of(mesh), state_of(decimation.mesh));
  }
}

TEST(Batch, IsNoPartOfAnExactLog) {
  DecimateOptions options;
  options.schedule = Schedule::exact;
  const IndexedMesh sphere = shapes::icosphere(3);
  EXPECT_TRUE(decimate(half_edges(sphere), sphere.positions, options).log.batch_ends.empty());
}

TEST(BatchElements, InheritTheGreatestKey) {
  BatchElements<VertexId> elements(3);
  const VertexId v(1);
  elements.put(v, 9, 2);
  EXPECT_EQ(elements.weighed_key(v), 18);
  for (const float key : {3.0f, 5.0f, 0.0f}) elements.change_by_one_of_many<true>(v, key);
  EXPECT_TRUE(elements.is_changed(v));
  EXPECT_EQ(elements.key(v), 5);
  elements.put(v, 4, 1);
  EXPECT_FALSE(elements.is_changed(v));
  elements.change_by_one_of_many<false>(v, 7);
  EXPECT_TRUE(elements.is_changed(v));
  EXPECT_EQ(elements.key(v), 4);
}

TEST(BatchKey, IsNeverBelowTheCost) {
  for (const double cost : {0.0, 1e-60, 1e-20, 0.1, 1.0 / 3, 1e30}) {
    EXPECT_GE(static_cast<double>(batch_key(cost)), cost);
  }
  EXPECT_EQ(batch_key(kRefused), kNoKey);
}

TEST(BatchRank, IsLessForKeysThatAreAnEighthLess) {
  for (const float key : {1e-20f, 0.3f, 1.0f, 7.0f}) {
    for (std::uint32_t v = 0; v < 20; ++v) {
      EXPECT_LT(batch_rank(key, VertexId(v)), batch_rank(key * 1.13f, VertexId(v + 1)));
    }
  }
}

}  // namespace
}  // namespace pmesh
