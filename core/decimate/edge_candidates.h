// Edge collapses with free placement for the engine: every edge is queued, under the lesser of its
// half-edges' ids. Private to core/decimate; see engine.h for what an engine asks of its
// candidates.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/edge_patch.h"
#include "core/decimate/edge_pricer.h"
#include "core/decimate/edge_star.h"
#include "core/decimate/legality.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

template <EdgeMetric M>
class EdgeCandidates {
 public:
  using ElementId = HalfEdgeId;
  static constexpr std::uint32_t kCollapsesPerStep = 1;

  struct Scratch {
    PhaseMark mark;
    EdgeStar star;
    Placement placement;
    OneRing ring;  // neighbours only
    EdgePricer<M> pricer;

    // To be called when the mesh has changed.
    void forget() { pricer.forget(); }
  };

  EdgeCandidates(WorkingMesh& work, const M& metric, std::span<const std::uint8_t> locked)
      : work_(work), metric_(metric), locked_(locked), patch_(work, SummaryMetric<M>) {
    metric_.start(work.mesh(), work.positions(), work.frame());
  }

  std::uint32_t slots() const { return 3 * work_.mesh().face_slots(); }
  std::uint32_t candidate_guess() const { return work_.mesh().live_faces() / 2 * 3 + 3; }

  // The cost of the edge. The link condition and fold-overs are left until it is popped.
  double evaluate(HalfEdgeId edge, double /*popped*/, Scratch& scratch) const {
    if (!is_candidate(edge)) return kRefused;
    scratch.mark.enter(DecimationPhase::gather);
    gather_ends(work_, edge, scratch.star);
    if (!may_merge(scratch.star)) return kRefused;
    scratch.placement = scratch.pricer.place(work_, metric_, scratch.star, scratch.mark);
    return scratch.placement.cost;
  }

  // What a popped edge is worth that was not collapsed: nothing, until a vertex near it has
  // changed; or its cost, if that had risen unnoticed since it was queued.
  double evaluate_legal(HalfEdgeId edge, double popped, Scratch& scratch) const {
    const double cost = evaluate(edge, popped, scratch);
    return cost > popped ? cost : kRefused;
  }

  // Whether the edge can be collapsed at the cost it was queued with.
  bool may_collapse(HalfEdgeId edge, double popped, Scratch& scratch) const {
    if (!(evaluate(edge, popped, scratch) <= popped)) return false;
    scratch.mark.enter(DecimationPhase::legality);
    const auto [removed, kept] = choose_removed(scratch.star);
    if (!gather_neighbours(work_.mesh(), removed, scratch.ring)) return false;
    if (!link_condition_holds(work_.mesh(), scratch.ring, scratch.ring.index_of(kept))) {
      return false;
    }
    if (!gather_star(work_, scratch.star)) return false;
    return may_fold_over_ || !folds_over(scratch.star, scratch.placement.position);
  }

  // False if the popped edge cannot be collapsed at the cost it was queued with.
  bool collapse(HalfEdgeId edge, double popped, Scratch& scratch) {
    if (!may_collapse(edge, popped, scratch)) return false;
    scratch.mark.enter(DecimationPhase::collapse);
    const EdgeStar& star = scratch.star;
    const auto [removed, kept] = choose_removed(star);
    const Vec3d position = scratch.placement.position;
    note_gone(edge);
    metric_.fold(star, removed, kept, position);
    work_.collapse(removed, edge, work_.frame().from_unit(star.origin + position));
    scratch.pricer.forget();
    patch_.gather(kept);
    return true;
  }

  template <class Popped, class Put>
  void evaluate_each(std::span<const HalfEdgeId> elements, const Popped& popped, const Put& put,
                     Scratch& scratch) const {
    for (const HalfEdgeId e : elements) put(e, evaluate(e, popped(e), scratch), 1);
  }

  std::span<const HalfEdgeId> gone() const { return gone_; }
  std::span<const HalfEdgeId> changed() const {
    return SummaryMetric<M> ? patch_.edges() : patch_.merged_edges();
  }
  std::span<const HalfEdgeId> touched() const {
    return SummaryMetric<M> ? std::span<const HalfEdgeId>() : patch_.other_edges();
  }

  std::span<const double> evaluate_changed(double popped, Scratch& scratch) {
    if constexpr (SummaryMetric<M>) {
      scratch.mark.enter(DecimationPhase::cost);
      scratch.pricer.price(work_, metric_, patch_, costs_);
      refuse_locked();
    } else {
      costs_.clear();
      for (const HalfEdgeId edge : changed()) costs_.push_back(evaluate(edge, popped, scratch));
    }
    return costs_;
  }

  bool is_live(HalfEdgeId h) const { return work_.mesh().is_live(HalfEdgeMesh::face(h)); }
  std::array<VertexId, 2> moved(HalfEdgeId edge) const {
    return {work_.mesh().origin(edge), work_.mesh().target(edge)};
  }
  std::span<const VertexId> ring() {
    gather_merged(work_, ring_);
    return ring_;
  }

  void expect(HalfEdgeId /*next*/) {}

  std::optional<Relaxation> relax() {
    if (std::exchange(may_fold_over_, true)) return std::nullopt;
    return Relaxation::fold_over;
  }

 private:
  HalfEdgeId edge_of(HalfEdgeId h) const {
    const HalfEdgeId twin = work_.mesh().twin(h);
    return twin.valid() ? std::min(h, twin) : h;
  }

  bool is_candidate(HalfEdgeId h) const {
    return work_.mesh().is_live(HalfEdgeMesh::face(h)) && edge_of(h) == h;
  }

  bool is_locked(VertexId v) const { return !locked_.empty() && locked_[v.value] != 0; }

  void refuse_locked() {
    if (locked_.empty()) return;
    for (std::size_t i = 0; i < costs_.size(); ++i) {
      const auto [a, b, left, right] = patch_.corners()[i];
      if (is_locked(patch_.vertex(a)) || is_locked(patch_.vertex(b))) costs_[i] = kRefused;
    }
  }

  // Border vertices merge along their border only. (An interior vertex may merge into it.)
  bool may_merge(const EdgeStar& star) const {
    if (is_locked(star.a) || is_locked(star.b)) return false;
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
    const HalfEdgeId first = work_.mesh().outgoing(v);
    HalfEdgeId h = first;
    std::uint32_t count = 0;
    do {
      h = work_.mesh().rotate_ccw(h);
    } while (++count <= EdgeStar::kMaxFaces && h.valid() && h != first);
    return count;
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

  WorkingMesh& work_;
  M metric_;
  std::span<const std::uint8_t> locked_;
  EdgePatch patch_;  // around the last collapse's merged vertex
  std::vector<HalfEdgeId> gone_;
  std::vector<double> costs_;
  std::vector<VertexId> ring_;  // of the last merged vertex, it included
  bool may_fold_over_ = false;
};

}  // namespace pmesh
