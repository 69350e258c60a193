// Triangle collapses for the engine: every face is queued.
// Private to core/decimate; see engine.h for what an engine asks of its candidates.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/legality.h"
#include "core/decimate/one_ring.h"
#include "core/decimate/triangle_star.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

template <TriangleMetric M>
class TriangleCandidates {
 public:
  using ElementId = FaceId;
  static constexpr std::uint32_t kCollapsesPerStep = 2;

  struct Scratch {
    PhaseMark mark;
    TriangleStar star;
  };

  TriangleCandidates(WorkingMesh& work, const M& metric, std::span<const std::uint8_t> locked)
      : work_(work), metric_(metric), locked_(locked) {}

  std::uint32_t slots() const { return work_.mesh().face_slots(); }
  std::uint32_t candidate_guess() const { return work_.mesh().live_faces(); }

  // The cost of the face. Its star is left until it is popped.
  double evaluate(FaceId face, double /*popped*/, Scratch& scratch) const {
    if (!work_.mesh().is_live(face)) return kRefused;
    scratch.mark.enter(DecimationPhase::gather);
    if (!gather_triangle(work_, face, scratch.star) || is_locked(scratch.star)) return kRefused;
    scratch.mark.enter(DecimationPhase::cost);
    return metric_.cost(scratch.star);
  }

  // What a popped face is worth that was not collapsed: nothing, until a vertex near it has
  // changed; or its cost, if that had risen unnoticed since it was queued.
  double evaluate_legal(FaceId face, double popped, Scratch& scratch) const {
    const double cost = evaluate(face, popped, scratch);
    return cost > popped ? cost : kRefused;
  }

  // Whether the face can be collapsed at the cost it was queued with.
  bool may_collapse(FaceId face, double popped, Scratch& scratch) const {
    if (!(evaluate(face, popped, scratch) <= popped)) return false;
    scratch.mark.enter(DecimationPhase::legality);
    return is_legal(face, scratch.star);
  }

  // False if the popped face cannot be collapsed at the cost it was queued with.
  bool collapse(FaceId face, double popped, Scratch& scratch) {
    if (!may_collapse(face, popped, scratch)) return false;
    scratch.mark.enter(DecimationPhase::collapse);
    note_gone(face);
    const TriangleStar& star = scratch.star;
    const auto [first, second, last] = star.order;
    const VertexId kept = star.corners[last];
    merge(star.corners[first], kept, star.centroid);
    merge(star.corners[second], kept, star.centroid);
    note_changed(kept);
    return true;
  }

  template <class Popped, class Put>
  void evaluate_each(std::span<const FaceId> elements, const Popped& popped, const Put& put,
                     Scratch& scratch) const {
    for (const FaceId e : elements) put(e, evaluate(e, popped(e), scratch), 1);
  }

  std::span<const FaceId> gone() const { return gone_; }
  std::span<const FaceId> changed() const { return changed_; }
  std::span<const FaceId> touched() const { return touched_; }

  std::span<const double> evaluate_changed(double popped, Scratch& scratch) {
    costs_.clear();
    for (const FaceId face : changed_) costs_.push_back(evaluate(face, popped, scratch));
    return costs_;
  }

  bool is_live(FaceId face) const { return work_.mesh().is_live(face); }
  std::array<VertexId, 3> moved(FaceId face) const {
    const auto corners = work_.mesh().corners().subspan(3 * std::size_t{face.value}, 3);
    return {corners[0], corners[1], corners[2]};
  }
  std::span<const VertexId> ring() {
    gather_merged(work_, ring_);
    return ring_;
  }

  void expect(FaceId /*next*/) {}

  std::optional<Relaxation> relax() {
    if (round_ + 1 < M::kRounds) {
      return ++round_ < M::kPlanarRounds ? Relaxation::turn : Relaxation::planarity;
    }
    if (std::exchange(may_fold_over_, true)) return std::nullopt;
    return Relaxation::fold_over;
  }

 private:
  bool is_locked(const TriangleStar& star) const {
    if (locked_.empty()) return false;
    const auto [a, b, c] = star.corners;
    return (locked_[a.value] | locked_[b.value] | locked_[c.value]) != 0;
  }

  // Gathers the rest of `star`, as far as need be.
  bool is_legal(FaceId face, TriangleStar& star) const {
    const bool is_last_round = round_ + 1 == M::kRounds;
    if (round_ < M::kPlanarRounds && !metric_.is_planar(star)) return false;
    if (!is_last_round && leaves_valence_three(work_.mesh(), face)) return false;
    if (!gather_star(work_, star) || !link_conditions_hold(star)) return false;
    return may_fold_over_ || !turns_faces(star, metric_.least_cosine(round_));
  }

  void merge(VertexId removed, VertexId kept, Vec3d position) {
    work_.collapse(removed, work_.mesh().find_edge(removed, kept), position);
  }

  // At most the first TriangleStar::kMaxFaces half-edges. Returns whether there are no more.
  template <class Visit>
  bool for_each_outgoing(VertexId v, const Visit& visit) const {
    const HalfEdgeId first = work_.mesh().outgoing(v);
    HalfEdgeId h = first;
    for (std::uint32_t count = 0; count < TriangleStar::kMaxFaces; ++count) {
      visit(h);
      h = work_.mesh().rotate_ccw(h);
      if (!h.valid() || h == first) return true;
    }
    return false;
  }

  void note_gone(FaceId face) {
    gone_.assign({face});
    for (std::uint32_t k = 0; k < 3; ++k) {
      gone_.push_back(HalfEdgeMesh::face(work_.mesh().twin(HalfEdgeId(3 * face.value + k))));
    }
  }

  // Faces with a corner or an apex in `kept` have changed. Those around its neighbours may have
  // become legal.
  void note_changed(VertexId kept) {
    changed_.clear();
    touched_.clear();
    for_each_outgoing(kept, [&](HalfEdgeId h) {
      changed_.push_back(HalfEdgeMesh::face(h));
      const HalfEdgeId across = work_.mesh().twin(HalfEdgeMesh::next(h));
      if (across.valid()) changed_.push_back(HalfEdgeMesh::face(across));
      touch_faces(work_.mesh().target(h));
    });
  }

  // No face of a border vertex or of a hub is a candidate.
  void touch_faces(VertexId v) {
    if (work_.mesh().is_border(v)) return;
    const std::size_t before = touched_.size();
    const bool is_whole =
        for_each_outgoing(v, [&](HalfEdgeId h) { touched_.push_back(HalfEdgeMesh::face(h)); });
    if (!is_whole) touched_.resize(before);
  }

  WorkingMesh& work_;
  M metric_;
  std::span<const std::uint8_t> locked_;
  std::vector<FaceId> gone_, changed_, touched_;
  std::uint32_t round_ = 0;
  std::vector<double> costs_;
  std::vector<VertexId> ring_;  // of the last merged vertex, it included
  bool may_fold_over_ = false;
};

}  // namespace pmesh
