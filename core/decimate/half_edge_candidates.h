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
    return choose(scratch, least(scratch), popped, head);
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

  // Collapses the popped vertex into the head that its evaluation chose; false if that is illegal.
  bool collapse(VertexId removed, double /*popped*/, Scratch& scratch) {
    scratch.mark.enter(DecimationPhase::legality);
    const VertexId kept = heads_[removed.value];
    [[maybe_unused]] const bool gathered = gather_neighbours(work_.mesh(), removed, scratch.ring);
    assert(gathered);
    if (!is_legal(scratch, scratch.ring.index_of(kept))) return false;
    ahead_.step();
    scratch.mark.enter(DecimationPhase::collapse);
    changed_.assign(scratch.ring.ids.begin(), scratch.ring.ids.begin() + scratch.ring.neighbours);
    work_.collapse(removed, work_.mesh().find_edge(removed, kept));
    metric_.fold(removed, kept);
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
};

}  // namespace pmesh
