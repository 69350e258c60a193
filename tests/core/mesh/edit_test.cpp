// The heart of a progressive mesh: collapse and split are exact inverses, on every shape.
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/half_edge_mesh.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/core/mesh/mesh_state.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

constexpr std::size_t kValidateEvery = 7;

struct Decimated {
  HalfEdgeMesh mesh;
  std::vector<HalfEdgeCollapse> log;
};

// Makes every legal collapse in pseudo-random order until none is left.
Decimated collapse_all(const IndexedMesh& shape) {
  Decimated result;
  result.mesh =
      HalfEdgeMesh::build(shape.triangles, static_cast<std::uint32_t>(shape.positions.size()))
          .value();
  std::mt19937 random(12345);
  std::vector<HalfEdgeId> order;
  for (std::uint32_t h = 0; h < 3 * shape.triangles.size(); ++h) order.emplace_back(h);
  std::size_t before;
  do {
    before = result.log.size();
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    for (const HalfEdgeId h : order) {
      if (!result.mesh.is_live(HalfEdgeMesh::face(h))) continue;
      const VertexId removed = random() % 2 ? result.mesh.origin(h) : result.mesh.target(h);
      if (!may_collapse(result.mesh, removed, h)) continue;
      result.log.push_back(result.mesh.collapse(removed, h));
      if (result.log.size() % kValidateEvery == 0) {
        const Status status = result.mesh.validate();
        EXPECT_TRUE(status) << status.error().message;
        if (!status) return result;
      }
    }
  } while (result.log.size() > before);
  return result;
}

// The base of `decimated` without dead slots, and the log in the ids that its splits will give.
class Replay {
 public:
  explicit Replay(const Decimated& decimated) {
    const HalfEdgeMesh& mesh = decimated.mesh;
    new_ids_.resize(mesh.vertex_slots());
    for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
      if (mesh.is_live(VertexId(v))) name_next(v);
    }
    std::vector<Triangle> triangles;
    for (std::uint32_t f = 0; f < mesh.face_slots(); ++f) {
      if (!mesh.is_live(FaceId(f))) continue;
      const std::span<const VertexId> t = mesh.corners().subspan(3 * f, 3);
      triangles.push_back({renamed(t[0]).value, renamed(t[1]).value, renamed(t[2]).value});
    }
    base_ = HalfEdgeMesh::build(triangles, mesh.live_vertices()).value();
    for (auto done = decimated.log.rbegin(); done != decimated.log.rend(); ++done) {
      name_next(done->removed.value);
      log_.push_back(
          {renamed(done->removed), renamed(done->kept), renamed(done->left), renamed(done->right)});
    }
  }

  const HalfEdgeMesh& base() const { return base_; }
  /// The collapses to undo, first to last.
  const std::vector<HalfEdgeCollapse>& log() const { return log_; }

  std::vector<Triangle> original_triangles(const HalfEdgeMesh& mesh) const {
    std::vector<Triangle> triangles(mesh.face_slots());
    for (std::uint32_t h = 0; h < mesh.corners().size(); ++h) {
      triangles[h / 3][h % 3] = old_ids_[mesh.corners()[h].value];
    }
    return triangles;
  }

 private:
  void name_next(std::uint32_t old_id) {
    new_ids_[old_id] = VertexId(static_cast<std::uint32_t>(old_ids_.size()));
    old_ids_.push_back(old_id);
  }
  VertexId renamed(VertexId v) const { return v.valid() ? new_ids_[v.value] : v; }

  std::vector<VertexId> new_ids_;
  std::vector<std::uint32_t> old_ids_;
  HalfEdgeMesh base_;
  std::vector<HalfEdgeCollapse> log_;
};

class OnEveryShape : public testing::TestWithParam<shapes::Shape> {};

TEST_P(OnEveryShape, CollapsesKeepTheInvariants) {
  const Decimated decimated = collapse_all(GetParam().mesh);
  const Status status = decimated.mesh.validate();
  EXPECT_TRUE(status) << status.error().message;
  const std::size_t removed = GetParam().mesh.positions.size() - decimated.mesh.live_vertices();
  EXPECT_EQ(decimated.log.size(), removed);
}

TEST_P(OnEveryShape, SplitsRebuildWhatCollapsesRemoved) {
  const Replay replay(collapse_all(GetParam().mesh));
  HalfEdgeMesh mesh = replay.base();
  for (std::size_t i = 0; i < replay.log().size(); ++i) {
    const HalfEdgeCollapse& done = replay.log()[i];
    const SplitSite site = mesh.find_site(done);
    ASSERT_TRUE(mesh.check(site)) << i;
    ASSERT_EQ(site.added_faces(), done.removed_faces());
    const MeshState before = state_of(mesh);
    ASSERT_EQ(mesh.split(site), done.kept);
    mesh.undo_split(site);
    ASSERT_EQ(state_of(mesh), before) << i;
    ASSERT_EQ(mesh.split(site), done.kept);
    if (i % kValidateEvery == 0) {
      ASSERT_TRUE(mesh.validate()) << i;
    }
  }
  EXPECT_TRUE(mesh.validate());
  EXPECT_EQ(sorted_triangles(replay.original_triangles(mesh)),
            sorted_triangles(GetParam().mesh.triangles));
}

TEST_P(OnEveryShape, UndoingAllSplitsRestoresTheBase) {
  const Replay replay(collapse_all(GetParam().mesh));
  HalfEdgeMesh mesh = replay.base();
  std::vector<SplitSite> sites;
  for (const HalfEdgeCollapse& done : replay.log()) {
    sites.push_back(mesh.find_site(done));
    mesh.split(sites.back());
  }
  const MeshState full = state_of(mesh);
  for (std::size_t i = sites.size(); i-- > 0;) mesh.undo_split(sites[i]);
  EXPECT_EQ(state_of(mesh), state_of(replay.base()));
  EXPECT_TRUE(mesh.validate());
  for (const SplitSite& site : sites) mesh.split(site);
  EXPECT_EQ(state_of(mesh), full);
}

INSTANTIATE_TEST_SUITE_P(HalfEdgeMeshEdit, OnEveryShape, testing::ValuesIn(shapes::manifolds()),
                         [](const auto& shape) { return shape.param.name; });

TEST(HalfEdgeMeshEdit, ASphereCollapsesToATetrahedron) {
  EXPECT_EQ(collapse_all(shapes::icosphere(2)).mesh.live_faces(), 4u);
}

TEST(HalfEdgeMeshEdit, AGridCollapsesToATriangle) {
  EXPECT_EQ(collapse_all(shapes::grid(6, 5)).mesh.live_faces(), 1u);
}

TEST(HalfEdgeMeshEdit, CollapseNamesTheApexes) {
  const IndexedMesh disc = shapes::hub(6);
  HalfEdgeMesh mesh = HalfEdgeMesh::build(disc.triangles, 7).value();
  const HalfEdgeCollapse done = mesh.collapse(VertexId(0), HalfEdgeId(0));  // 0 -> 1
  EXPECT_EQ(done.kept, VertexId(1));
  EXPECT_EQ(done.left, VertexId(2));
  EXPECT_EQ(done.right, VertexId(6));
  EXPECT_EQ(mesh.live_faces(), 4u);
  EXPECT_FALSE(mesh.is_live(VertexId(0)));
}

}  // namespace
}  // namespace pmesh
