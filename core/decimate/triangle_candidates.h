// Triangle collapses for the engine: every face is queued.
// Private to core/decimate; see engine.h for what an engine asks of its candidates.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/legality.h"
#include "core/decimate/triangle_star.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

template <TriangleMetric M>
class TriangleCandidates {
 public:
  using ElementId = FaceId;
  static constexpr std::uint32_t kCollapsesPerStep = 2;

  // What one thread needs to evaluate a face.
  struct Scratch {
    PhaseMark mark;
    TriangleStar star;
  };

  TriangleCandidates(WorkingMesh& work, const M& metric, std::span<const std::uint8_t> locked)
      : work_(work), metric_(metric), locked_(locked) {}

  std::uint32_t slots() const { return work_.mesh().face_slots(); }

  // The cost of the face. Its star is left until it is popped.
  double evaluate(FaceId face, double /*popped*/, Scratch& scratch) {
    if (!work_.mesh().is_live(face)) return kRefused;
    scratch.mark.enter(DecimationPhase::gather);
    if (!gather_triangle(work_, face, scratch.star) || is_locked(scratch.star)) return kRefused;
    scratch.mark.enter(DecimationPhase::cost);
    return metric_.cost(scratch.star);
  }

  // What a popped face is worth that was not collapsed: nothing, until a vertex near it has
  // changed; or its cost, if that had risen unnoticed since it was queued.
  double evaluate_legal(FaceId face, double popped, Scratch& scratch) {
    const double cost = evaluate(face, popped, scratch);
    return cost > popped ? cost : kRefused;
  }

  // False if the popped face cannot be collapsed at the cost it was queued with.
  bool collapse(FaceId face, double popped, Scratch& scratch) {
    if (!(evaluate(face, popped, scratch) <= popped)) return false;
    scratch.mark.enter(DecimationPhase::legality);
    const TriangleStar& star = scratch.star;
    if (!gather_star(work_, scratch.star)) return false;
    if (!may_bend_ && !metric_.is_planar(star)) return false;
    if (!link_conditions_hold(star)) return false;
    if (!may_fold_over_ && folds_over(star)) return false;

    scratch.mark.enter(DecimationPhase::collapse);
    note_gone(face);
    const auto [first, second, last] = star.order;
    const VertexId kept = star.corners[last];
    merge(star.corners[first], kept, star.centroid);
    merge(star.corners[second], kept, star.centroid);
    note_changed(kept);
    return true;
  }

  std::span<const FaceId> gone() const { return gone_; }
  std::span<const FaceId> changed() const { return changed_; }
  std::span<const FaceId> touched() const { return touched_; }

  // Gives up the next test, if there is one left.
  std::optional<Relaxation> relax() {
    if (!std::exchange(may_bend_, true)) return Relaxation::planarity;
    if (!std::exchange(may_fold_over_, true)) return Relaxation::fold_over;
    return std::nullopt;
  }

 private:
  bool is_locked(const TriangleStar& star) const {
    if (locked_.empty()) return false;
    const auto [a, b, c] = star.corners;
    return (locked_[a.value] | locked_[b.value] | locked_[c.value]) != 0;
  }

  void merge(VertexId removed, VertexId kept, Vec3d position) {
    work_.collapse(removed, work_.mesh().find_edge(removed, kept), position);
  }

  // At most the first TriangleStar::kMaxFaces half-edges: greater hubs are corners of no candidate.
  template <class Visit>
  void for_each_outgoing(VertexId v, const Visit& visit) const {
    const HalfEdgeId first = work_.mesh().outgoing(v);
    HalfEdgeId h = first;
    std::uint32_t count = 0;
    do {
      visit(h);
      h = work_.mesh().rotate_ccw(h);
    } while (h.valid() && h != first && ++count < TriangleStar::kMaxFaces);
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
      for_each_outgoing(work_.mesh().target(h),
                        [&](HalfEdgeId outer) { touched_.push_back(HalfEdgeMesh::face(outer)); });
    });
  }

  WorkingMesh& work_;
  M metric_;
  std::span<const std::uint8_t> locked_;
  std::vector<FaceId> gone_, changed_, touched_;
  bool may_bend_ = false;
  bool may_fold_over_ = false;
};

}  // namespace pmesh
