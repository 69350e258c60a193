// The engine against the paper's algorithm written for clarity: costs are made anew for the
// neighbours of each removed vertex; in every step the best legal half-edge of every vertex, by the
// link condition as it is defined, is looked for among all.
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "core/decimate/decimate.h"
#include "core/decimate/indexed_heap.h"
#include "core/decimate/legality.h"
#include "tests/core/decimate/rings.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Reference {
 public:
  explicit Reference(const IndexedMesh& mesh)
      : work_(half_edges(mesh), mesh.positions), vertices_(mesh.positions.size()) {
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) evaluate(VertexId(v), 0);
  }

  /// The next collapse, if there is one.
  std::optional<HalfEdgeCollapse> step() {
    Choice best;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v) {
      if (!mesh_.is_live(VertexId(v))) continue;
      const Choice choice = choose_head(VertexId(v));
      if (choice.value < best.value || (choice.value == best.value && choice.head.valid() &&
                                        tie_rank(choice.removed) < tie_rank(best.removed))) {
        best = choice;
      }
    }
    if (!best.head.valid()) return std::nullopt;
    std::vector<VertexId> changed;
    for (const Half& half : vertices_[best.removed.value].halves) changed.push_back(half.head);
    work_.collapse(best.removed, mesh_.find_edge(best.removed, best.head));
    for (const VertexId v : changed) evaluate(v, best.value);
    return work_.log().collapses.back();
  }

 private:
  struct Half {
    VertexId head;
    double cost = kInfinity;
  };
  struct Vertex {
    std::vector<Half> halves;  // one for each neighbour
    double importance = 0;
    double inherited = 0;
  };
  struct Choice {
    VertexId removed, head;
    double value = kInfinity;
  };

  void evaluate(VertexId v, double popped) {
    EXPECT_TRUE(gather_neighbours(mesh_, v, ring_));
    gather_positions(work_, ring_);
    gather_faces(ring_);
    Vertex& vertex = vertices_[v.value];
    vertex = {{}, Melod::importance(ring_), popped};
    for (std::uint32_t i = 0; i < ring_.neighbours; ++i) {
      vertex.halves.push_back({ring_.ids[i]});
      if (!may_move_to(ring_, i)) continue;
      move_faces(ring_, i, moved_);
      if (folds_over(ring_, moved_)) continue;
      vertex.halves[i].cost = Melod().cost(ring_, {vertex.importance}, i, moved_);
    }
  }

  // The cheapest legal half-edge of `v`, valued by its key.
  Choice choose_head(VertexId v) const {
    const Vertex& vertex = vertices_[v.value];
    Choice cheapest;
    for (const auto& [head, cost] : vertex.halves) {
      if (cost == kInfinity || !may_collapse(mesh_, v, mesh_.find_edge(v, head))) continue;
      if (cost < cheapest.value ||
          (cost == cheapest.value && tie_rank(head) < tie_rank(cheapest.head))) {
        cheapest = {v, head, cost};
      }
    }
    if (cheapest.head.valid()) {
      cheapest.value = vertex.importance * std::max(cheapest.value, vertex.inherited);
    }
    return cheapest;
  }

  WorkingMesh work_;
  const HalfEdgeMesh& mesh_ = work_.mesh();
  std::vector<Vertex> vertices_;
  OneRing ring_;
  MovedFaces moved_;
};

class AgainstReference : public testing::TestWithParam<shapes::Shape> {};

TEST_P(AgainstReference, MakesTheSameCollapsesInTheSameOrder) {
  DecimateOptions options;
  options.schedule = Schedule::exact;
  options.metric = Melod();
  options.base_faces = 0;
  const IndexedMesh& mesh = GetParam().mesh;
  const Decimation result = decimate(half_edges(mesh), mesh.positions, options);
  Reference reference(mesh);
  std::size_t count = 0;
  while (const std::optional<HalfEdgeCollapse> expected = reference.step()) {
    ASSERT_LT(count, result.log.collapses.size());
    const HalfEdgeCollapse& logged = result.log.collapses[count++];
    ASSERT_EQ(logged.removed, expected->removed) << "collapse " << count;
    ASSERT_EQ(logged.kept, expected->kept) << "collapse " << count;
  }
  EXPECT_TRUE(result.report.fold_over_relaxed_at_faces || count == result.log.collapses.size());
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, AgainstReference,
    testing::Values(shapes::Shape{"Icosphere", shapes::bumped(shapes::icosphere(2), 0.05)},
                    shapes::Shape{"RegularIcosphere", shapes::icosphere(2)},
                    shapes::Shape{"Torus", shapes::bumped(shapes::torus(12, 8), 0.03)},
                    shapes::Shape{"ThinTorus", shapes::bumped(shapes::torus(30, 4), 0.02)},
                    shapes::Shape{"SpikyTorus", shapes::bumped(shapes::torus(24, 5), 0.4)},
                    shapes::Shape{"SpikyGenus", shapes::bumped(shapes::genus(1), 0.6)},
                    shapes::Shape{"Genus", shapes::bumped(shapes::genus(1), 0.3)},
                    shapes::Shape{"Grid", shapes::bumped(shapes::grid(12, 9), 0.03)},
                    shapes::Shape{"GridWithEars", shapes::bumped(shapes::grid_with_ears(4), 0.02)},
                    shapes::Shape{"Components", shapes::components(12)}),
    [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace pmesh
