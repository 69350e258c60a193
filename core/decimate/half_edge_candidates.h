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

#include "core/decimate/batch_claims.h"
#include "core/decimate/decimate.h"
#include "core/decimate/head_pricer.h"
#include "core/decimate/legality.h"
#include "core/decimate/metric.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/ring_ahead.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

template <HalfEdgeMetric M>
class HalfEdgeCandidates {
 public:
  using ElementId = VertexId;
  static constexpr std::uint32_t kCollapsesPerStep = 1;

  struct Scratch {
    PhaseMark mark;
    OneRing ring;
    MovedFaces moved;
    HeadPricer<M> pricer;
  };

  HalfEdgeCandidates(WorkingMesh& work, const M& metric, const DecimateOptions& options)
      : work_(work),
        metric_(metric),
        locked_(options.locked),
        by_shape_(options.schedule == Schedule::batched),
        heads_(work.mesh().vertex_slots()),
        claims_(work.mesh()),
        ahead_(work) {
    metric_.start(work.mesh(), work.positions(), work.frame(), options.threads);
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
    HeadPricer<M>& pricer = scratch.pricer;
    pricer.price(metric_, scratch.ring, may_fold_over_);
    std::uint32_t best = pricer.cheapest(work_, metric_, scratch.ring);
    if (by_shape_ && best != kNoIndex) best = pricer.shapeliest(metric_, scratch.ring, best);
    return choose(scratch, best, popped, head);
  }

  // Evaluates `vertices` and hands each to put(v, key, coding factor); popped(v) as above.
  template <class Popped, class Put>
  void evaluate_each(std::span<const VertexId> vertices, const Popped& popped, const Put& put,
                     Scratch& scratch) {
    RingLanes& lanes = scratch.pricer.lanes;
    lanes.clear();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (i + kAhead < vertices.size()) metric_.prefetch(vertices[i + kAhead]);
      const VertexId v = vertices[i];
      if (!PricesLanes<M> || is_locked(v) || !lanes.add(work_, v)) {
        const double key = evaluate(v, popped(v), scratch);
        put(v, key, key < kRefused ? coding_factor(off_centre(scratch.ring)) : 1);
      } else if (lanes.is_full()) {
        evaluate_lanes(put, scratch.pricer);
      }
    }
    evaluate_lanes(put, scratch.pricer);
  }

  // Evaluates the popped vertex `v`, whose best candidate proved illegal, among its legal ones. Its
  // key is what it would have been had that been known before.
  double evaluate_legal(VertexId v, double popped, Scratch& scratch) {
    VertexId& head = heads_[v.value] = VertexId();
    if (!gather(v, scratch)) return kRefused;
    HeadPricer<M>& pricer = scratch.pricer;
    pricer.price(metric_, scratch.ring, may_fold_over_);
    std::uint32_t best = pricer.cheapest(work_, metric_, scratch.ring);
    while (best != kNoIndex && !is_legal(scratch, best)) {
      pricer.refuse(best);
      best = pricer.cheapest(work_, metric_, scratch.ring);
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

  // What a batch does instead, for vertices that do not meet and were found legal: one after the
  // other they claim what they keep (see BatchClaims); those that stay legal, whose neighbours are
  // gathered into `ring`, fold the metric's state, all at the same time; then they are collapsed.
  void start_batch() { claims_.start_batch(); }
  bool claim(VertexId removed) { return claims_.claim(removed, heads_[removed.value]); }
  void release(VertexId removed) { claims_.release(heads_[removed.value]); }
  bool stays_legal(VertexId removed, OneRing& ring) const {
    gather_candidate(removed, ring);
    return claims_.stays_legal(ring, heads_[removed.value]);
  }
  void fold(VertexId removed) { metric_.fold(removed, heads_[removed.value]); }
  HalfEdgeCollapse edit(VertexId removed) {
    return work_.collapse_unlogged(removed,
                                   find_spoke(work_.mesh(), removed, heads_[removed.value]));
  }
  // Follows the mesh to compact ids.
  void renumber(const CompactIds& ids) {
    metric_.renumber(ids);
    close_up(heads_, ids.vertices);
    for (VertexId& head : heads_) {
      if (head.valid()) head = ids.new_vertices[head.value];
    }
  }
  // Whether a key depends on that of the collapse that made its evaluation necessary.
  static constexpr bool kInheritsKeys = M::kInheritsKeys;

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
  // Ask for what will soon be read of a vertex to be brought into the caches.
  void look_ahead(VertexId next) const {
    if (!is_live(next)) return;
    const HalfEdgeId first = work_.mesh().outgoing(next), before = work_.mesh().twin(first);
    work_.mesh().prefetch(first);
    if (before.valid()) work_.mesh().prefetch(before);
  }
  void look_ahead_to_fold(VertexId next) const {
    look_ahead(next);
    metric_.prefetch(next);
    metric_.prefetch(heads_[next.value]);
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
  static constexpr std::uint32_t kAhead = 6;
  static constexpr bool kMovesFaces = HeadPricer<M>::kMovesFaces;

  bool is_locked(VertexId v) const { return !locked_.empty() && locked_[work_.name(v).value] != 0; }

  // What evaluate() would say of the vertices in the lanes, which are cleared.
  template <class Put>
  void evaluate_lanes(const Put& put, HeadPricer<M>& pricer) {
    if constexpr (PricesLanes<M>) {
      assert(by_shape_);
      const RingLanes& lanes = pricer.lanes;
      pricer.price_lanes(
          work_, metric_,
          [&](std::uint32_t lane, std::uint32_t head, double cost, double off_centre) {
            const VertexId v = lanes.centre[lane];
            heads_[v.value] = lanes.ids[lane][head];
            put(v, cost, coding_factor(off_centre));
          });
    }
  }

  // False if `v` must not be removed.
  bool gather(VertexId v, Scratch& scratch) const {
    scratch.mark.enter(DecimationPhase::gather);
    if (is_locked(v)) return false;
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

  double choose(const Scratch& scratch, std::uint32_t best, double popped, VertexId& head) const {
    if (best == kNoIndex) return kRefused;
    head = scratch.ring.ids[best];
    return scratch.pricer.priority(metric_, best, popped);
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
  bool by_shape_;                // evaluate() chooses the shapeliest of the cheapest heads
  std::vector<VertexId> heads_;  // by vertex in the queue: the kept vertex of its best candidate
  BatchClaims claims_;
  std::vector<VertexId> changed_;
  std::vector<double> keys_;  // of changed_
  RingAhead ahead_;
  bool may_fold_over_ = false;
};

}  // namespace pmesh
