// Prices edges for EdgeCandidates: one, or all that a collapse has changed. A metric that sums over
// one-rings gets the sums made once for the edges of a vertex. Private to core/decimate.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/edge_patch.h"
#include "core/decimate/edge_star.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// For one thread.
template <class M>
class EdgePricer {
 public:
  /// To be called when the mesh has changed.
  void forget() {}

  /// The price of the edge whose ends `star` has; may gather the rest of it.
  Placement place(const WorkingMesh& work, const M& metric, EdgeStar& star, PhaseMark mark) {
    if (M::kNeedsStar && !gather_star(work, star)) return {};
    mark.enter(DecimationPhase::cost);
    return metric.place(star);
  }
};

template <SummaryMetric M>
class EdgePricer<M> {
 public:
  void forget() { ++state_; }

  Placement place(const WorkingMesh& work, const M& metric, const EdgeStar& star, PhaseMark mark) {
    const auto [a, b] = find_both(work, metric, star.a, star.b);
    mark.enter(DecimationPhase::cost);
    if (a == nullptr || b == nullptr) return {};
    const Edge edge{star, a, b};
    Placement placement;
    metric.place(std::span(&edge, 1), std::span(&placement, 1));
    return placement;
  }

  /// Puts the cost of every edge of `patch` into `costs`; kRefused if one end is a hub, or both,
  /// but not the edge, lie on a border.
  void price(const WorkingMesh& work, const M& metric, const EdgePatch& patch,
             std::vector<double>& costs) {
    sum_up(work, metric, patch);
    placed_.clear();
    which_.clear();
    for (std::uint32_t i = 0; i < patch.edges().size(); ++i) place_edge(work, patch, i);
    placements_.resize(placed_.size());
    metric.place(placed_, placements_);
    costs.assign(patch.edges().size(), kRefused);
    for (std::size_t i = 0; i < which_.size(); ++i) costs[which_[i]] = placements_[i].cost;
  }

 private:
  using Summary = typename M::Summary;
  using Edge = SummedEdge<Summary>;
  struct Sums {
    bool is_summed = false;
    Summary summary;
  };
  struct Entry : Sums {
    VertexId vertex;
    std::uint32_t state = 0;
  };

  void sum_up(const WorkingMesh& work, const M& metric, const EdgePatch& patch) {
    if (sums_.size() < patch.vertex_count()) sums_.resize(2 * patch.vertex_count());
    for (std::uint32_t v = 0; v < patch.vertex_count(); ++v) {
      sum_up(work, metric, patch.vertex(v), sums_[v]);
    }
  }

  void sum_up(const WorkingMesh& work, const M& metric, VertexId v, Sums& sums) {
    sums.is_summed = gather_ring(work, v, ring_);
    if (sums.is_summed) sums.summary = metric.summarise(ring_);
  }

  // Queues edge `i`, if it may be merged.
  void place_edge(const WorkingMesh& work, const EdgePatch& patch, std::uint32_t i) {
    const auto [a, b, left, right] = patch.corners()[i];
    const Sums &of_a = sums_[a], &of_b = sums_[b];
    const bool on_border = right == kNoIndex;
    if (!of_a.is_summed || !of_b.is_summed) return;
    if (of_a.summary.border && of_b.summary.border && !on_border) return;
    const Vec3d at_right = on_border ? Vec3d{} : patch.position(right);
    placed_.push_back({pmesh::place_edge(work.frame(), patch.position(a), patch.position(b),
                                         patch.position(left), at_right, on_border),
                       &of_a.summary, &of_b.summary});
    which_.push_back(i);
  }

  // Null where a vertex is a hub. Valid until the next call.
  std::pair<const Summary*, const Summary*> find_both(const WorkingMesh& work, const M& metric,
                                                      VertexId a, VertexId b) {
    const Summary* of_a = find(work, metric, a);
    if (of_a != nullptr && &entry_of(a) == &entry_of(b)) of_a = &(displaced_ = *of_a);
    return {of_a, find(work, metric, b)};
  }

  Entry& entry_of(VertexId v) { return entries_[v.value % entries_.size()]; }

  const Summary* find(const WorkingMesh& work, const M& metric, VertexId v) {
    Entry& entry = entry_of(v);
    if (entry.vertex != v || entry.state != state_) {
      entry.vertex = v;
      entry.state = state_;
      sum_up(work, metric, v, entry);
    }
    return entry.is_summed ? &entry.summary : nullptr;
  }

  std::array<Entry, 128> entries_;  // of vertices met since the mesh has changed
  std::uint32_t state_ = 0;
  Summary displaced_;
  PlacedRing ring_;
  // Of a patch.
  std::vector<Sums> sums_;            // by vertex
  std::vector<Edge> placed_;          // edges that may be merged
  std::vector<std::uint32_t> which_;  // of the patch's edges they are
  std::vector<Placement> placements_;
};

}  // namespace pmesh
