// Edge collapses with free placement for the engine: every edge is queued, under the lesser of its
// half-edges' ids. Private to core/decimate; see engine.h for what an engine asks of its
// candidates.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/edge_star.h"
#include "core/decimate/legality.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

// What a vertex's one-ring sums up to, for the vertices met since the last collapse. One thread's.
template <class M>
class SummaryCache {};

template <SummaryMetric M>
class SummaryCache<M> {
 public:
  using Summary = typename M::Summary;

  // Null where a vertex has more than OneRing::kMaxFaces faces. Valid until the next call. `step`
  // tells one state of the mesh from the others.
  std::pair<const Summary*, const Summary*> find_both(const WorkingMesh& work, const M& metric,
                                                      VertexId a, VertexId b, std::uint32_t step) {
    const Summary* of_a = find(work, metric, a, step);
    if (of_a != nullptr && &entry_of(a) == &entry_of(b)) of_a = &(displaced_ = *of_a);
    return {of_a, find(work, metric, b, step)};
  }

 private:
  struct Entry {
    VertexId vertex;
    std::uint32_t step = 0;
    bool is_summed = false;
    Summary summary;
  };

  Entry& entry_of(VertexId v) { return entries_[v.value % entries_.size()]; }

  const Summary* find(const WorkingMesh& work, const M& metric, VertexId v, std::uint32_t step) {
    Entry& entry = entry_of(v);
    if (entry.vertex != v || entry.step != step) {
      entry.vertex = v;
      entry.step = step;
      entry.is_summed = gather_ring(work, v, ring_);
      if (entry.is_summed) entry.summary = metric.summarise(ring_);
    }
    return entry.is_summed ? &entry.summary : nullptr;
  }

  std::array<Entry, 128> entries_;
  Summary displaced_;
  PlacedRing ring_;
};

template <EdgeMetric M>
class EdgeCandidates {
 public:
  using ElementId = HalfEdgeId;
  static constexpr std::uint32_t kCollapsesPerStep = 1;

  // What one thread needs to evaluate an edge.
  struct Scratch {
    PhaseMark mark;
    EdgeStar star;
    Placement placement;
    OneRing ring;  // neighbours only
    SummaryCache<M> summaries;
  };

  EdgeCandidates(WorkingMesh& work, const M& metric, std::span<const std::uint8_t> locked)
      : work_(work), metric_(metric), locked_(locked), ring_mark_(work.mesh().vertex_slots()) {
    metric_.start(work.mesh(), work.positions(), work.frame());
  }

  std::uint32_t slots() const { return 3 * work_.mesh().face_slots(); }
  std::uint32_t candidate_guess() const { return work_.mesh().live_faces() / 2 * 3 + 3; }

  // The cost of the edge. The link condition and fold-overs are left until it is popped.
  double evaluate(HalfEdgeId edge, double /*popped*/, Scratch& scratch) {
    if (!is_candidate(edge)) return kRefused;
    scratch.mark.enter(DecimationPhase::gather);
    gather_ends(work_, edge, scratch.star);
    if (!may_merge(scratch.star)) return kRefused;
    scratch.placement = place(scratch);
    return scratch.placement.cost;
  }

  // What a popped edge is worth that was not collapsed: nothing, until a vertex near it has
  // changed; or its cost, if that had risen unnoticed since it was queued.
  double evaluate_legal(HalfEdgeId edge, double popped, Scratch& scratch) {
    const double cost = evaluate(edge, popped, scratch);
    return cost > popped ? cost : kRefused;
  }

  // False if the popped edge cannot be collapsed at the cost it was queued with.
  bool collapse(HalfEdgeId edge, double popped, Scratch& scratch) {
    if (!(evaluate(edge, popped, scratch) <= popped)) return false;
    scratch.mark.enter(DecimationPhase::legality);
    EdgeStar& star = scratch.star;
    const auto [removed, kept] = choose_removed(star);
    if (!gather_neighbours(work_.mesh(), removed, scratch.ring)) return false;
    if (!link_condition_holds(work_.mesh(), scratch.ring, scratch.ring.index_of(kept))) {
      return false;
    }
    if (!gather_star(work_, star)) return false;
    const Vec3d position = scratch.placement.position;
    if (!may_fold_over_ && folds_over(star, position)) return false;

    scratch.mark.enter(DecimationPhase::collapse);
    note_gone(edge);
    metric_.fold(star, removed, kept, position);
    work_.collapse(removed, edge, work_.frame().from_unit(star.origin + position));
    note_changed(kept);
    return true;
  }

  std::span<const HalfEdgeId> gone() const { return gone_; }
  std::span<const HalfEdgeId> changed() const { return changed_; }
  std::span<const HalfEdgeId> touched() const { return touched_; }

  // Gives up the next test, if there is one left.
  std::optional<Relaxation> relax() {
    if (std::exchange(may_fold_over_, true)) return std::nullopt;
    return Relaxation::fold_over;
  }

 private:
  Placement place(Scratch& scratch) const {
    EdgeStar& star = scratch.star;
    if constexpr (SummaryMetric<M>) {
      const auto [a, b] = scratch.summaries.find_both(work_, metric_, star.a, star.b, step_);
      scratch.mark.enter(DecimationPhase::cost);
      return a == nullptr || b == nullptr ? Placement{} : metric_.place(star, *a, *b);
    } else {
      if (M::kNeedsStar && !gather_star(work_, star)) return {};
      scratch.mark.enter(DecimationPhase::cost);
      return metric_.place(star);
    }
  }

  HalfEdgeId edge_of(HalfEdgeId h) const {
    const HalfEdgeId twin = work_.mesh().twin(h);
    return twin.valid() ? std::min(h, twin) : h;
  }

  bool is_candidate(HalfEdgeId h) const {
    return work_.mesh().is_live(HalfEdgeMesh::face(h)) && edge_of(h) == h;
  }

  // Border vertices merge along their border only. (An interior vertex may merge into it.)
  bool may_merge(const EdgeStar& star) const {
    if (!locked_.empty() && (locked_[star.a.value] | locked_[star.b.value]) != 0) return false;
    return !(star.a_on_border && star.b_on_border) || work_.mesh().is_border(star.half_edge);
  }

  // The border vertex is kept; else the one of more faces, so that few faces move.
  std::pair<VertexId, VertexId> choose_removed(const EdgeStar& star) const {
    const std::pair ab(star.a, star.b), ba(star.b, star.a);
    if (star.a_on_border != star.b_on_border) return star.a_on_border ? ba : ab;
    return valence(star.a) <= valence(star.b) ? ab : ba;
  }

  // The faces of `v`, or some number above EdgeStar::kMaxFaces if there are more than that.
  std::uint32_t valence(VertexId v) const {
    std::uint32_t count = 0;
    for_each_outgoing(v, [&](HalfEdgeId) { ++count; });
    return count;
  }

  template <class Visit>
  void for_each_outgoing(VertexId v, const Visit& visit) const {
    const HalfEdgeId first = work_.mesh().outgoing(v);
    HalfEdgeId h = first;
    std::uint32_t count = 0;
    do {
      visit(h);
      h = work_.mesh().rotate_ccw(h);
    } while (h.valid() && h != first && ++count <= EdgeStar::kMaxFaces);
  }

  // Every edge of `v` with its other end.
  template <class Visit>
  void for_each_edge(VertexId v, const Visit& visit) const {
    HalfEdgeId last;
    for_each_outgoing(v, [&](HalfEdgeId h) {
      visit(edge_of(h), work_.mesh().target(h));
      last = HalfEdgeMesh::prev(h);
    });
    if (work_.mesh().is_border(last)) visit(last, work_.mesh().origin(last));
  }

  // The edges of the two faces that a collapse of `edge` deletes. One of each face's outer edges
  // survives, under an id that may be another: it is among the changed ones.
  void note_gone(HalfEdgeId edge) {
    gone_.clear();
    const HalfEdgeId twin = work_.mesh().twin(edge);
    for (const HalfEdgeId h : {edge, twin}) {
      if (!h.valid()) continue;
      gone_.push_back(edge_of(HalfEdgeMesh::next(h)));
      gone_.push_back(edge_of(HalfEdgeMesh::prev(h)));
    }
  }

  // Edges of hubs are no candidates, and stale in the queue until they are popped and dropped.
  bool is_hub(VertexId v) const { return valence(v) > EdgeStar::kMaxFaces; }

  void note_changed(VertexId kept) {
    changed_.clear();
    touched_.clear();
    ++step_;
    if (is_hub(kept)) return;
    for_each_edge(kept, [&](HalfEdgeId edge, VertexId neighbour) {
      changed_.push_back(edge);
      ring_mark_[neighbour.value] = step_;
    });
    ring_mark_[kept.value] = step_;
    std::vector<HalfEdgeId>& around = M::kReach == EdgeReach::ring ? changed_ : touched_;
    for_each_edge(kept, [&](HalfEdgeId, VertexId neighbour) {
      if (is_hub(neighbour)) return;
      for_each_edge(neighbour, [&](HalfEdgeId edge, VertexId other) {
        const bool seen_twice = ring_mark_[other.value] == step_;
        if (other != kept && !(seen_twice && other < neighbour)) around.push_back(edge);
      });
    });
  }

  WorkingMesh& work_;
  M metric_;
  std::span<const std::uint8_t> locked_;
  std::vector<HalfEdgeId> gone_, changed_, touched_;
  std::vector<std::uint32_t> ring_mark_;  // by vertex: the last step that had it in the ring
  std::uint32_t step_ = 0;
  bool may_fold_over_ = false;
};

}  // namespace pmesh
