// Prices the heads of vertices for HalfEdgeCandidates, of one ring or of a few side by side, and
// chooses among them. Private to core/decimate.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>

#include "core/base/vec3.h"
#include "core/decimate/indexed_heap.h"
#include "core/decimate/legality.h"
#include "core/decimate/metric.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/ring_lanes.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

// A metric that can say cheaply what a candidate costs at least.
template <class M>
concept HasFloor = requires(const M& metric, const OneRing& ring, std::uint32_t head) {
  { metric.floor(ring, metric.prepare(ring), head) } -> std::same_as<double>;
};

// A metric that prices the heads of several rings at once, to the bit as it does one by one.
template <class M>
concept PricesLanes = requires(const M& metric, const RingLanes& rings, LaneCosts& costs) {
  { metric.price(rings, costs) } -> std::same_as<void>;
};

/// Of neighbour `best` and those that is_alike(neighbour) is true of, the one from which the edges
/// to all others are shortest.
template <class Position, class IsAlike>
std::uint32_t shapeliest_of(std::uint32_t neighbours, std::uint32_t best, const Position& position,
                            const IsAlike& is_alike) {
  const auto new_edges = [&](std::uint32_t head) {
    double sum = 0;
    for (std::uint32_t i = 0; i < neighbours; ++i) sum += length(position(i) - position(head));
    return sum;
  };
  std::uint32_t chosen = best;
  double shortest = kRefused;  // not yet known
  for (std::uint32_t i = 0; i < neighbours; ++i) {
    if (i == best || !is_alike(i)) continue;
    if (shortest == kRefused) shortest = new_edges(best);
    const double edges = new_edges(i);
    if (edges >= shortest) continue;
    shortest = edges;
    chosen = i;
  }
  return chosen;
}

/// The squared distance of the ring's centre from its neighbours' middle over their variance; 0 if
/// they have none.
inline double off_centre(const OneRing& ring) {
  Vec3d sum{};
  double squares = 0;
  for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
    const Vec3d p = ring.position(i);
    sum += p;
    squares += dot(p, p);
  }
  const double n = ring.neighbours, off = dot(sum, sum) / (n * n), spread = squares / n - off;
  return spread > 0 ? off / spread : 0;
}

/// By how much a key is to be raised for the sake of the codec, which expects a vertex in the
/// middle of its ring.
inline double coding_factor(double off_centre) {
  constexpr double kCostOfOffCentre = 4;  // docs/decisions/0012
  return 1 + kCostOfOffCentre * off_centre;
}

/// For one thread. A head is an index among a ring's neighbours.
template <HalfEdgeMetric M>
class HeadPricer {
 public:
  static constexpr bool kMovesFaces = M::kGeometry == RingGeometry::moved_faces;

  /// Prices all heads of the ring's centre; what is asked below is of them.
  void price(const M& metric, const OneRing& ring, bool may_fold_over) {
    prepared_ = metric.prepare(ring);
    for (std::uint32_t head = 0; head < ring.neighbours; ++head) {
      costs_[head] = kRefused;
      if (!may_move_to(ring, head)) continue;
      if constexpr (kMovesFaces) {
        move_faces(ring, head, moved_);
        if (!may_fold_over && folds_over(ring, moved_)) continue;
      }
      if constexpr (HasFloor<M>) {
        is_floor_[head] = true;
        costs_[head] = metric.floor(ring, prepared_, head);
      } else {
        costs_[head] = metric.cost(ring, prepared_, head, moved_);
      }
    }
  }

  void refuse(std::uint32_t head) { costs_[head] = kRefused; }

  /// The head of the least finite cost, or kNoIndex.
  std::uint32_t cheapest(const WorkingMesh& work, const M& metric, const OneRing& ring) {
    std::uint32_t best = least_known(work, ring);
    if constexpr (HasFloor<M>) {
      while (best != kNoIndex && is_floor_[best]) {
        make_known(metric, ring, best);
        best = least_known(work, ring);
      }
    }
    return best;
  }

  /// Of the heads that cost no more than the cheapest, `best`, but for a thousandth of an edge's
  /// length off the faces around (in the metrics that weigh squared distances by areas; less in
  /// others), the one that leaves the shortest edges: on flat ground, where all cost nothing, whim
  /// would leave fans that no codec can guess.
  std::uint32_t shapeliest(const M& metric, const OneRing& ring, std::uint32_t best) {
    const double square = squared_edge(ring);
    const double most = costs_[best] + kNegligible * square * square;
    if constexpr (HasFloor<M>) {
      for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
        if (costs_[i] <= most && is_floor_[i]) make_known(metric, ring, i);
      }
    }
    return shapeliest_of(
        ring.neighbours, best, [&](std::uint32_t i) { return ring.position(i); },
        [&](std::uint32_t i) { return costs_[i] <= most; });
  }

  /// The metric's, for a head that one of these has chosen.
  double priority(const M& metric, std::uint32_t head, double popped) const {
    return metric.priority(prepared_, costs_[head], popped);
  }

  /// Rings to be priced together.
  RingLanes lanes;

  /// Prices the rings in the lanes, and empties these. Calls choose(lane, head, cost,
  /// off_centre), the head being the shapeliest.
  template <class Choose>
  void price_lanes(const WorkingMesh& work, const M& metric,
                   const Choose& choose) requires PricesLanes<M> {
    lanes.close();
    metric.price(lanes, lane_costs_);
    const LaneChoices choices = choose_heads(lanes, lane_costs_, kNegligible);
    for (std::uint32_t lane = 0; lane < lanes.used; ++lane) {
      const std::uint32_t head = shapeliest_in(lane, work, choices);
      choose(lane, head, lane_costs_[head][lane], choices.off_centre[lane]);
    }
    lanes.clear();
  }

 private:
  // Of a cost: so many times the fourth power of an edge's length.
  static constexpr double kNegligible = 1e-6;

  void make_known(const M& metric, const OneRing& ring, std::uint32_t head) {
    is_floor_[head] = false;
    costs_[head] = metric.cost(ring, prepared_, head, moved_);
  }

  std::uint32_t least_known(const WorkingMesh& work, const OneRing& ring) const {
    double least = kRefused;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) least = std::min(least, costs_[i]);
    if (least == kRefused) return kNoIndex;
    std::uint32_t best = 0;
    while (costs_[best] != least) ++best;
    for (std::uint32_t i = best + 1; i < ring.neighbours; ++i) {
      if (costs_[i] == least && ties_before(work, ring.ids[i], ring.ids[best])) best = i;
    }
    return best;
  }

  // What cheapest() and shapeliest() would choose.
  std::uint32_t shapeliest_in(std::uint32_t lane, const WorkingMesh& work,
                              const LaneChoices& choices) const {
    auto best = static_cast<std::uint32_t>(choices.best[lane]);
    if (!(choices.alike[lane] > 1)) return best;
    const std::uint32_t count = lanes.count[lane];
    const auto cost = [&](std::uint32_t i) { return lane_costs_[i][lane]; };
    for (std::uint32_t i = best + 1; i < count; ++i) {
      if (cost(i) == cost(best) && ties_before(work, lanes.ids[lane][i], lanes.ids[lane][best])) {
        best = i;
      }
    }
    return shapeliest_of(
        count, best, [&](std::uint32_t i) { return lanes.position(lane, i); },
        [&](std::uint32_t i) { return cost(i) <= choices.most[lane]; });
  }

  static bool ties_before(const WorkingMesh& work, VertexId a, VertexId b) {
    return tie_rank(work.name(a)) < tie_rank(work.name(b));
  }

  static double squared_edge(const OneRing& ring) {
    double sum = 0;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      sum += dot(ring.position(i), ring.position(i));
    }
    return sum / ring.neighbours;
  }

  typename M::Prepared prepared_;
  MovedFaces moved_;
  std::array<double, OneRing::kMaxFaces + 1> costs_;
  std::array<bool, OneRing::kMaxFaces + 1> is_floor_;  // costs_[i] is a lower bound as yet
  LaneCosts lane_costs_;
};

}  // namespace pmesh
