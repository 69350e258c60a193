// Half-edge collapses for the engine: every vertex is queued once, with its best head.
// Private to core/decimate; see engine.h for what an engine asks of its candidates.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/batch_marks.h"
#include "core/decimate/indexed_heap.h"
#include "core/decimate/legality.h"
#include "core/decimate/metric.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/ring_ahead.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

// A metric that can say cheaply what a candidate costs at least.
template <class M>
concept HasFloor = requires(const M& metric, const OneRing& ring, std::uint32_t head) {
  { metric.floor(ring, metric.prepare(ring), head) } -> std::same_as<double>;
};

template <HalfEdgeMetric M>
class HalfEdgeCandidates {
 public:
  using ElementId = VertexId;
  static constexpr std::uint32_t kCollapsesPerStep = 1;

  struct Scratch {
    PhaseMark mark;
    OneRing ring;
    typename M::Prepared prepared;
    MovedFaces moved;
    std::array<double, OneRing::kMaxFaces + 1> costs;
    std::array<bool, OneRing::kMaxFaces + 1> is_floor;  // costs[i] is a lower bound as yet
  };

  HalfEdgeCandidates(WorkingMesh& work, const M& metric, std::span<const std::uint8_t> locked)
      : work_(work),
        metric_(metric),
        locked_(locked),
        heads_(work.mesh().vertex_slots()),
        ahead_(work) {
    metric_.start(work.mesh(), work.positions(), work.frame());
  }

  std::uint32_t slots() const { return work_.mesh().vertex_slots(); }
  std::uint32_t candidate_guess() const { return work_.mesh().live_vertices(); }

  // The key of `v`'s cheapest candidate, which is legal but for the link condition (and, if the
  // metric does not look at moved faces, for fold-overs). That needs the rings of v's neighbours
  // and waits until v is popped: it refuses few, and a refusal only raises the cost.
  double evaluate(VertexId v, double popped, Scratch& scratch) {
    VertexId& head = heads_[v.value] = VertexId();
    if (!work_.mesh().is_live(v) || !gather(v, scratch)) return kRefused;
    scratch.mark.enter(DecimationPhase::cost);
    price(scratch);
    const std::uint32_t best = least(scratch);
    return choose(scratch, by_shape_ && best != kNoIndex ? shapeliest(scratch, best) : best, popped,
                  head);
  }

  // From now on evaluate() takes, of the heads as cheap as the cheapest, the one that leaves the
  // shortest edges: on flat ground, where all cost nothing, whim would leave fans that no codec
  // can guess.
  void choose_ties_by_shape() { by_shape_ = true; }

  // After evaluate(): how much less than its key says the vertex should be removed, for the sake of
  // the codec, which expects it in the middle of its ring. At least 1.
  static double coding_factor(const Scratch& scratch) {
    const OneRing& ring = scratch.ring;
    Vec3d sum{};
    double squares = 0;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      const Vec3d p = ring.position(i);
      sum += p;
      squares += dot(p, p);
    }
    const double n = ring.neighbours, off = dot(sum, sum) / (n * n), spread = squares / n - off;
    return spread > 0 ? 1 + kCostOfOffCentre * off / spread : 1;
  }

  // Evaluates the popped vertex `v`, whose best candidate proved illegal, among its legal ones. Its
  // key is what it would have been had that been known before.
  double evaluate_legal(VertexId v, double popped, Scratch& scratch) {
    VertexId& head = heads_[v.value] = VertexId();
    if (!gather(v, scratch)) return kRefused;
    price(scratch);
    std::uint32_t best = least(scratch);
    while (best != kNoIndex && !is_legal(scratch, best)) {
      scratch.costs[best] = kRefused;
      best = least(scratch);
    }
    return std::max(popped, choose(scratch, best, 0, head));
  }

  // Whether the head that `v`'s evaluation chose is a legal one.
  bool may_collapse(VertexId v, double /*popped*/, Scratch& scratch) const {
    scratch.mark.enter(DecimationPhase::legality);
    gather_candidate(v, scratch.ring);
    return is_legal(scratch, scratch.ring.index_of(heads_[v.value]));
  }

  // Collapses the popped vertex into the head that its evaluation chose; false if that is illegal.
  bool collapse(VertexId removed, double popped, Scratch& scratch) {
    if (!may_collapse(removed, popped, scratch)) return false;
    ahead_.step();
    commit(removed, scratch);
    return true;
  }

  // The same for a vertex that was found legal, in a batch that has taken `marks` since.
  bool collapse_unless_taken(VertexId removed, double /*popped*/, const BatchMarks& marks,
                             Scratch& scratch) {
    if (marks.is_kept(heads_[removed.value])) return false;
    gather_candidate(removed, scratch.ring);
    if (meets_kept(marks, scratch.ring, heads_[removed.value])) return false;
    commit(removed, scratch);
    return true;
  }

  std::span<const VertexId> gone() const { return {}; }
  std::span<const VertexId> changed() const { return changed_; }
  std::span<const VertexId> touched() const { return {}; }

  std::span<const double> evaluate_changed(double popped, Scratch& scratch) {
    prefetch_changed();
    keys_.clear();
    for (const VertexId v : changed_) {
      ahead_.step();
      keys_.push_back(evaluate(v, popped, scratch));
    }
    return keys_;
  }

  bool is_live(VertexId v) const { return work_.mesh().is_live(v); }
  std::array<VertexId, 1> moved(VertexId v) const { return {v}; }
  std::span<const VertexId> ring() const { return changed_; }

  void look_ahead(VertexId next) const {
    if (!is_live(next)) return;
    metric_.prefetch(next);
    const HalfEdgeId first = work_.mesh().outgoing(next), before = work_.mesh().twin(first);
    work_.mesh().prefetch(first);
    if (before.valid()) work_.mesh().prefetch(before);
  }

  void expect(VertexId next) {
    ahead_.start(next);
    metric_.prefetch(next);
    __builtin_prefetch(&heads_[next.value]);
  }

  std::optional<Relaxation> relax() {
    if (std::exchange(may_fold_over_, true)) return std::nullopt;
    return Relaxation::fold_over;
  }

 private:
  static constexpr double kNegligible = 1e-6;
  static constexpr double kCostOfOffCentre = 4;  // docs/decisions/0012
  static constexpr bool kMovesFaces = M::kGeometry == RingGeometry::moved_faces;

  // False if `v` must not be removed.
  bool gather(VertexId v, Scratch& scratch) const {
    scratch.mark.enter(DecimationPhase::gather);
    if (!locked_.empty() && locked_[v.value] != 0) return false;
    if (!gather_neighbours(work_.mesh(), v, scratch.ring)) return false;
    if constexpr (HasFloor<M>) prefetch_heads(scratch.ring);
    gather_positions(work_, scratch.ring);
    if constexpr (M::kGeometry != RingGeometry::neighbours) gather_faces(scratch.ring);
    return true;
  }

  void gather_candidate(VertexId v, OneRing& ring) const {
    [[maybe_unused]] const bool gathered = gather_neighbours(work_.mesh(), v, ring);
    assert(gathered);
  }

  // Into the head that the evaluation of `removed`, whose neighbours were gathered, chose.
  void commit(VertexId removed, Scratch& scratch) {
    scratch.mark.enter(DecimationPhase::collapse);
    const OneRing& ring = scratch.ring;
    const VertexId kept = heads_[removed.value];
    changed_.assign(ring.ids.begin(), ring.ids.begin() + ring.neighbours);
    work_.collapse(removed, work_.mesh().find_edge(removed, kept));
    metric_.fold(removed, kept);
  }

  // Whether a batch's collapses have broken the link condition of one that does not meet them: they
  // only add edges between what they kept and what was around what they removed. So if `kept` now
  // has an edge to a neighbour that another one has kept, it may be a second one.
  bool meets_kept(const BatchMarks& marks, const OneRing& ring, VertexId kept) const {
    const auto is_met = [&](VertexId v) { return v != kept && marks.is_kept(v); };
    const std::span neighbours(ring.ids.data(), ring.neighbours);
    return std::any_of(neighbours.begin(), neighbours.end(), is_met) &&
           !link_condition_holds(work_.mesh(), ring, ring.index_of(kept));
  }

  // The metric's state of a head is read if the floor of its cost does not rule it out.
  void prefetch_heads(const OneRing& ring) const {
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) metric_.prefetch(ring.ids[i]);
  }

  // The collapse itself has just read one side of the changed vertices; this asks for the other.
  void prefetch_changed() const {
    for (const VertexId v : changed_) {
      metric_.prefetch(v);
      const HalfEdgeId first = work_.mesh().outgoing(v), before = work_.mesh().rotate_cw(first);
      work_.prefetch(work_.mesh().target(first));
      if (before.valid()) work_.mesh().prefetch(before);
    }
  }

  // The costs of all candidates of the gathered vertex.
  void price(Scratch& scratch) const {
    auto& [mark, ring, prepared, moved, costs, is_floor] = scratch;
    prepared = metric_.prepare(ring);
    for (std::uint32_t head = 0; head < ring.neighbours; ++head) {
      costs[head] = kRefused;
      if (!may_move_to(ring, head)) continue;
      if constexpr (kMovesFaces) {
        move_faces(ring, head, moved);
        if (!may_fold_over_ && folds_over(ring, moved)) continue;
      }
      if constexpr (HasFloor<M>) {
        is_floor[head] = true;
        costs[head] = metric_.floor(ring, prepared, head);
      } else {
        costs[head] = metric_.cost(ring, prepared, head, moved);
      }
    }
  }

  // The neighbour of the least finite cost, or kNoIndex.
  std::uint32_t least(Scratch& scratch) const {
    std::uint32_t best = least_known(scratch);
    if constexpr (HasFloor<M>) {
      while (best != kNoIndex && scratch.is_floor[best]) {
        scratch.is_floor[best] = false;
        scratch.costs[best] = metric_.cost(scratch.ring, scratch.prepared, best, scratch.moved);
        best = least_known(scratch);
      }
    }
    return best;
  }

  static std::uint32_t least_known(const Scratch& scratch) {
    const auto& costs = scratch.costs;
    const OneRing& ring = scratch.ring;
    std::uint32_t best = kNoIndex;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      if (!(costs[i] < kRefused)) continue;
      if (best == kNoIndex || costs[i] < costs[best] ||
          (costs[i] == costs[best] && tie_rank(ring.ids[i]) < tie_rank(ring.ids[best]))) {
        best = i;
      }
    }
    return best;
  }

  // Of the candidates that cost no more than `best` but for a thousandth of an edge's length off
  // the faces around (in the metrics that weigh squared distances by areas; less in others).
  std::uint32_t shapeliest(Scratch& scratch, std::uint32_t best) const {
    auto& [mark, ring, prepared, moved, costs, is_floor] = scratch;
    const double square = length_squared_of_edges(ring);
    const double most = costs[best] + kNegligible * square * square;
    std::uint32_t chosen = best;
    double shortest = new_edges(ring, best);
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      if (i == best || !(costs[i] <= most)) continue;
      if constexpr (HasFloor<M>) {
        if (is_floor[i]) {
          is_floor[i] = false;
          costs[i] = metric_.cost(ring, prepared, i, moved);
          if (!(costs[i] <= most)) continue;
        }
      }
      const double length = new_edges(ring, i);
      if (length >= shortest) continue;
      shortest = length;
      chosen = i;
    }
    return chosen;
  }

  static double length_squared_of_edges(const OneRing& ring) {
    double sum = 0;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      sum += dot(ring.position(i), ring.position(i));
    }
    return sum / ring.neighbours;
  }

  // The length of the edges from neighbour `head` to all others.
  static double new_edges(const OneRing& ring, std::uint32_t head) {
    double sum = 0;
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      sum += length(ring.position(i) - ring.position(head));
    }
    return sum;
  }

  double choose(const Scratch& scratch, std::uint32_t best, double popped, VertexId& head) const {
    if (best == kNoIndex) return kRefused;
    head = scratch.ring.ids[best];
    return metric_.priority(scratch.prepared, scratch.costs[best], popped);
  }

  // For a candidate of finite cost, whose neighbours were gathered.
  bool is_legal(Scratch& scratch, std::uint32_t head) const {
    if (!link_condition_holds(work_.mesh(), scratch.ring, head)) return false;
    if (kMovesFaces || may_fold_over_) return true;
    gather_positions(work_, scratch.ring);
    gather_faces(scratch.ring);
    move_faces(scratch.ring, head, scratch.moved);
    return !folds_over(scratch.ring, scratch.moved);
  }

  WorkingMesh& work_;
  M metric_;
  std::span<const std::uint8_t> locked_;
  std::vector<VertexId> heads_;  // by vertex in the queue: the kept vertex of its best candidate
  std::vector<VertexId> changed_;
  std::vector<double> keys_;  // of changed_
  RingAhead ahead_;
  bool may_fold_over_ = false;
  bool by_shape_ = false;
};

}  // namespace pmesh
