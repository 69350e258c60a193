#include "core/pm/batch_builder.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "core/decimate/decimate.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

// A decimated shape, its base, and a builder that takes the log back.
class Replay {
 public:
  explicit Replay(const IndexedMesh& shape)
      : lattice_(*make_lattice(shape.positions, 12)),
        input_{quantise(shape.positions, lattice_), shape.triangles},
        decimation_(decimated(shape)) {
    const LiveMesh live = decimation_.mesh.live();
    builder_.emplace(decimation_.log, input_.positions, lattice_);
    LatticeMesh base{{}, live.triangles};
    for (const VertexId v : live.vertices) {
      builder_->place(v, VertexId(static_cast<std::uint32_t>(base.positions.size())));
      base.positions.push_back(input_.positions[v.value]);
    }
    mesh_.emplace(*RefinableMesh::from_base(base));
    state_.emplace(*mesh_);
    std::vector<std::uint32_t> splits(decimation_.log.collapses.size());
    std::iota(splits.begin(), splits.end(), 0u);
    builder_->add(splits);
  }

  std::size_t left() const { return builder_->left(); }
  const CollapseLog& log() const { return decimation_.log; }
  const RefinableMesh& mesh() const { return *mesh_; }
  const LatticeMesh& input() const { return input_; }

  std::vector<BatchSplit> next() { return builder_->next(*mesh_, *state_); }
  BatchMesh& state() { return *state_; }
  /// The splits of next()'s batch from `begin` on, or some of them.
  void apply(const std::vector<BatchSplit>& splits, std::size_t begin = 0) {
    const std::uint32_t first_vertex = mesh_->vertex_count();
    ASSERT_TRUE(state_->apply(splits, *mesh_).ok());
    builder_->applied(begin, state_->order(), first_vertex);
  }

 private:
  static Decimation decimated(const IndexedMesh& shape) {
    auto connectivity =
        HalfEdgeMesh::build(shape.triangles, static_cast<std::uint32_t>(shape.positions.size()));
    DecimateOptions options;
    options.metric = *make_metric("melod");
    options.base_faces = 16;
    return decimate(std::move(*connectivity), shape.positions, options);
  }

  Lattice lattice_;
  LatticeMesh input_;
  Decimation decimation_;
  std::optional<RefinableMesh> mesh_;
  std::optional<BatchMesh> state_;
  std::optional<BatchBuilder> builder_;
};

TEST(BatchBuilder, GivesBackTheMeshThatWasDecimated) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    Replay replay(shape.mesh);
    while (replay.left() > 0) replay.apply(replay.next());
    EXPECT_TRUE(same_triangles(replay.mesh().snapshot(), replay.input())) << shape.name;
  }
}

// The faces that a split covers, found by walking from face to face.
std::vector<FaceId> covered_faces(const HalfEdgeMesh& mesh, const SplitSite& site) {
  std::vector<FaceId> faces = {HalfEdgeMesh::face(site.half_edge)};
  const bool clockwise = site.kind == SplitKind::border_last;
  HalfEdgeId h = clockwise ? HalfEdgeMesh::next(site.half_edge) : site.half_edge;
  for (int more = site.moved_faces - 1; more > 0; --more) {
    h = clockwise ? mesh.rotate_cw(h) : mesh.rotate_ccw(h);
    faces.push_back(HalfEdgeMesh::face(h));
  }
  return faces;
}

void expect_apart(const std::vector<BatchSplit>& batch, const HalfEdgeMesh& mesh) {
  std::vector<int> covers(mesh.live_faces());
  for (const BatchSplit& entry : batch) {
    EXPECT_EQ(entry.kept, kept_vertex(mesh, entry.split.site));
    for (const FaceId f : covered_faces(mesh, entry.split.site)) EXPECT_EQ(covers[f.value]++, 0);
  }
}

// By id if they are named, else by the sweep.
void expect_in_order(const std::vector<BatchSplit>& batch, BatchMesh& state) {
  const auto sweep = state.vertices_to_sweep();
  std::vector<VertexId> order(sweep.begin(), sweep.end());
  if (state.order_of(batch.size()) == BatchOrder::ids) std::sort(order.begin(), order.end());
  auto at = order.begin();
  for (const BatchSplit& entry : batch) {
    at = std::find(at, order.end(), entry.kept);
    ASSERT_NE(at++, order.end());
  }
}

TEST(BatchBuilder, SplitsOfABatchKeepApartAndComeInTheOrderOfTheirVertices) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    Replay replay(shape.mesh);
    while (replay.left() > 0) {
      const auto batch = replay.next();
      ASSERT_FALSE(batch.empty());
      expect_apart(batch, replay.mesh().connectivity());
      expect_in_order(batch, replay.state());
      replay.apply(batch);
    }
  }
}

TEST(BatchBuilder, PartsOfABatchCanBeAppliedOneAfterTheOther) {
  Replay replay(shapes::bumped(shapes::icosphere(4), 0.05));
  while (replay.left() > 0) {
    const std::vector<BatchSplit> batch = replay.next();
    const std::size_t part = batch.size() / 3 + 1;
    for (std::size_t begin = 0; begin < batch.size(); begin += part) {
      const std::size_t end = std::min(batch.size(), begin + part);
      replay.apply({batch.begin() + static_cast<std::ptrdiff_t>(begin),
                    batch.begin() + static_cast<std::ptrdiff_t>(end)},
                   begin);
    }
  }
  EXPECT_TRUE(same_triangles(replay.mesh().snapshot(), replay.input()));
}

TEST(BatchBuilder, TakesTheNextRecordsOfTheLogAndLeavesTheRest) {
  Replay replay(shapes::bumped(shapes::grid(12, 9), 0.05));
  while (replay.left() > 0) {
    const std::size_t before = replay.left();
    const auto batch = replay.next();
    EXPECT_EQ(replay.left(), before - batch.size());
    replay.apply(batch);
  }
}

// Whether a record of log[begin, end) names a vertex that another one adds, or keeps the same.
bool need_each_other(const CollapseLog& log, std::size_t begin, std::size_t end) {
  std::set<VertexId> added, kept;
  bool need = false;
  for (std::size_t i = end; i-- > begin;) {
    const HalfEdgeCollapse& record = log.collapses[i];
    for (const VertexId v : {record.kept, record.left, record.right}) need |= added.contains(v);
    need |= !kept.insert(record.kept).second;
    added.insert(record.removed);
  }
  return need;
}

TEST(BatchBuilder, PartsRecordsThatNeedEachOther) {
  Replay replay(shapes::bumped(shapes::icosphere(3), 0.05));
  ASSERT_TRUE(need_each_other(replay.log(), 0, replay.left()));
  while (replay.left() > 0) {
    const std::size_t end = replay.left();
    const auto batch = replay.next();
    EXPECT_FALSE(need_each_other(replay.log(), replay.left(), end));
    replay.apply(batch);
  }
}

}  // namespace
}  // namespace pmesh
