// Edge collapses by the engine against the same done slowly: in every step all edges are priced
// anew, and the cheapest legal one, by the link condition as it is defined, is collapsed.
#include <optional>

#include <gtest/gtest.h>

#include "core/decimate/decimate.h"
#include "core/decimate/edge_star.h"
#include "core/decimate/indexed_heap.h"
#include "tests/core/decimate/rings.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

template <class M>
class Reference {
 public:
  explicit Reference(const IndexedMesh& mesh) : work_(half_edges(mesh), mesh.positions) {
    metric_.start(work_.mesh(), work_.positions(), work_.frame());
  }

  /// Makes the next collapse; false if there is none.
  bool step() {
    std::optional<Choice> best;
    for (std::uint32_t h = 0; h < 3 * mesh_.face_slots(); ++h) {
      const std::optional<Choice> choice = consider(HalfEdgeId(h));
      if (choice &&
          (!best || choice->cost < best->cost ||
           (choice->cost == best->cost && tie_rank(choice->edge) < tie_rank(best->edge)))) {
        best = choice;
      }
    }
    if (!best) return false;
    gather(best->edge);
    metric_.fold(star_, best->removed, best->kept, best->position);
    work_.collapse(best->removed, best->edge,
                   work_.frame().from_unit(star_.origin + best->position));
    return true;
  }

  const WorkingMesh& work() const { return work_; }

 private:
  struct Choice {
    HalfEdgeId edge;
    VertexId removed, kept;
    double cost = 0;
    Vec3d position;
  };

  void gather(HalfEdgeId edge) {
    gather_ends(work_, edge, star_);
    EXPECT_TRUE(gather_star(work_, star_));
  }

  // The edge's collapse, if `h` is the lesser of its half-edges and it may be collapsed.
  std::optional<Choice> consider(HalfEdgeId h) {
    if (!mesh_.is_live(HalfEdgeMesh::face(h)) || mesh_.twin(h) < h) return std::nullopt;
    gather(h);
    const bool on_border = mesh_.is_border(h);
    if (star_.a_on_border && star_.b_on_border && !on_border) return std::nullopt;
    const bool remove_a = star_.a_on_border == star_.b_on_border
                              ? valence(star_.a) <= valence(star_.b)
                              : star_.b_on_border;
    const auto [removed, kept] =
        remove_a ? std::pair(star_.a, star_.b) : std::pair(star_.b, star_.a);
    const Placement placement = place();
    if (!(placement.cost < kRefused) || folds_over(star_, placement.position) ||
        !may_collapse(mesh_, removed, h)) {
      return std::nullopt;
    }
    return Choice{h, removed, kept, placement.cost, placement.position};
  }

  Placement place() const {
    if constexpr (SummaryMetric<M>) {
      const auto a = summary(star_.a), b = summary(star_.b);
      const SummedEdge<typename M::Summary> edge{star_, &a, &b};
      Placement placement;
      metric_.place(std::span(&edge, 1), std::span(&placement, 1));
      return placement;
    } else {
      return metric_.place(star_);
    }
  }

  auto summary(VertexId v) const {
    PlacedRing ring;
    EXPECT_TRUE(gather_ring(work_, v, ring));
    return metric_.summarise(ring);
  }

  std::uint32_t valence(VertexId v) const {
    OneRing ring;
    EXPECT_TRUE(gather_neighbours(mesh_, v, ring));
    return ring.faces;
  }

  WorkingMesh work_;
  const HalfEdgeMesh& mesh_ = work_.mesh();
  M metric_;
  EdgeStar star_;
};

template <class M>
void expect_the_same_collapses(const shapes::Shape& shape) {
  SCOPED_TRACE(std::string(M::kName) + " on " + shape.name);
  DecimateOptions options;
  options.schedule = Schedule::exact;
  options.metric = M();
  options.base_faces = 0;
  const Decimation result = decimate(half_edges(shape.mesh), shape.mesh.positions, options);
  Reference<M> reference(shape.mesh);
  std::size_t count = 0;
  while (reference.step()) {
    ASSERT_LT(count, result.log.collapses.size());
    const CollapseLog& expected = reference.work().log();
    ASSERT_EQ(result.log.collapses[count].removed, expected.collapses[count].removed) << count;
    ASSERT_EQ(result.log.collapses[count].kept, expected.collapses[count].kept) << count;
    ASSERT_EQ(result.log.kept_before[count], expected.kept_before[count]) << count;
    ++count;
  }
  EXPECT_TRUE(result.report.fold_over_relaxed_at_faces || count == result.log.collapses.size());
}

TEST(EdgeReference, TheEngineMakesTheSameCollapsesInTheSameOrder) {
  for (const shapes::Shape& shape :
       {shapes::Shape{"Icosphere", shapes::bumped(shapes::icosphere(2), 0.05)},
        shapes::Shape{"ThinTorus", shapes::bumped(shapes::torus(30, 4), 0.02)},
        shapes::Shape{"SpikyTorus", shapes::bumped(shapes::torus(24, 5), 0.4)},
        shapes::Shape{"Grid", shapes::bumped(shapes::grid(12, 9), 0.03)},
        shapes::Shape{"GridWithEars", shapes::bumped(shapes::grid_with_ears(4), 0.02)},
        shapes::Shape{"Components", shapes::components(12)}}) {
    expect_the_same_collapses<QemSolved>(shape);
    expect_the_same_collapses<Memoryless>(shape);
  }
}

}  // namespace
}  // namespace pmesh
