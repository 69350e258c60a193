// The mesh in the making: what a decimation's candidates and its engine share.
#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/border_loops.h"
#include "core/decimate/collapse_log.h"
#include "core/decimate/metric_frame.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// What a decimation is doing at a moment.
enum class DecimationPhase : std::uint8_t { evaluate_all, heap, gather, cost, legality, collapse };
inline constexpr int kDecimationPhases = 6;

/// Tells a profiler, if there is one, which phase is entered.
struct PhaseMark {
  std::atomic<DecimationPhase>* phase = nullptr;

  void enter(DecimationPhase entered) const {
    if (phase != nullptr) phase->store(entered, std::memory_order_relaxed);
  }
};

/// Connectivity, positions and borders, edited together, and the log of the edits.
class WorkingMesh {
 public:
  WorkingMesh(HalfEdgeMesh mesh, std::vector<Vec3d> positions)
      : mesh_(std::move(mesh)),
        positions_(std::move(positions)),
        frame_(metric_frame(positions_)),
        borders_(mesh_) {
    assert(positions_.size() == mesh_.vertex_slots());
    log_.collapses.reserve(mesh_.live_vertices());
  }
  WorkingMesh(const WorkingMesh&) = delete;  // borders_ refers to mesh_
  WorkingMesh& operator=(const WorkingMesh&) = delete;

  const HalfEdgeMesh& mesh() const { return mesh_; }
  const std::vector<Vec3d>& positions() const { return positions_; }
  Vec3d position(VertexId v) const { return positions_[v.value]; }
  const MetricFrame& frame() const { return frame_; }
  const BorderLoops& borders() const { return borders_; }
  const CollapseLog& log() const { return log_; }

  /// The id that `v` has in the input, in the log and in what is taken in the end.
  VertexId name(VertexId v) const { return names_.empty() ? v : names_[v.value]; }

  /// Gives what is live compact ids, so that it is not spread over more memory than it needs.
  /// Precondition: no vertex has been placed anew.
  CompactIds compact() {
    assert(log_.kept_before.empty());
    const std::uint32_t faces = mesh_.face_slots();
    CompactIds ids = mesh_.compact();
    borders_.renumber(ids);
    if (names_.empty()) {
      names_ = ids.vertices;
      face_names_ = ids.faces;
      input_faces_ = faces;
      input_positions_ = std::move(positions_);
      positions_.clear();
      for (const VertexId v : names_) positions_.push_back(input_positions_[v.value]);
    } else {
      close_up(names_, ids.vertices);
      close_up(face_names_, ids.faces);
      close_up(positions_, ids.vertices);
    }
    return ids;
  }

  /// Collapses `edge` as HalfEdgeMesh::collapse() does; the kept vertex stays where it is.
  void collapse(VertexId removed, HalfEdgeId edge) { log(collapse_unlogged(removed, edge)); }

  /// Its two steps. Several threads may take the first at the same time, as they may
  /// HalfEdgeMesh::collapse_uncounted().
  HalfEdgeCollapse collapse_unlogged(VertexId removed, HalfEdgeId edge) {
    if (mesh_.is_border(removed)) borders_.remove(removed);
    HalfEdgeCollapse done = mesh_.collapse_uncounted(removed, edge);
    if (names_.empty()) return done;
    for (VertexId* v : {&done.removed, &done.kept, &done.left, &done.right}) {
      if (v->valid()) *v = names_[v->value];
    }
    return done;
  }
  void log(const HalfEdgeCollapse& done) {
    mesh_.count(done);
    log_.collapses.push_back(done);
  }

  /// The same, and places the kept vertex at `position`.
  void collapse(VertexId removed, HalfEdgeId edge, Vec3d position) {
    if (log_.kept_before.empty()) log_.kept_before.reserve(log_.collapses.capacity());
    collapse(removed, edge);
    Vec3d& kept = positions_[log_.collapses.back().kept.value];
    log_.kept_before.push_back(kept);
    kept = position;
  }

  /// Ends a batch: all that has been collapsed since the last.
  void end_batch() { log_.batch_ends.push_back(static_cast<std::uint32_t>(log_.collapses.size())); }

  /// Puts a batch's steps of `per_step` collapses, of which the first is step `first`, into another
  /// order: by new place, the step's old place. May be called for several batches at the same time.
  void reorder_batch(std::uint32_t first, std::span<const std::uint32_t> order,
                     std::uint32_t per_step) {
    reorder(log_.collapses, first, order, per_step);
    if (!log_.kept_before.empty()) reorder(log_.kept_before, first, order, per_step);
  }

  /// Asks for what there is of `v` to be brought into the caches.
  void prefetch(VertexId v) const {
    mesh_.prefetch(v);
    __builtin_prefetch(&positions_[v.value]);
  }

  HalfEdgeMesh take_mesh() {
    if (!names_.empty()) {
      compact();
      mesh_.spread(names_, face_names_, static_cast<std::uint32_t>(input_positions_.size()),
                   input_faces_);
    }
    return std::move(mesh_);
  }
  std::vector<Vec3d> take_positions() {
    return std::move(names_.empty() ? positions_ : input_positions_);
  }
  CollapseLog take_log() { return std::move(log_); }

 private:
  template <class T>
  static void reorder(std::vector<T>& log, std::uint32_t first,
                      std::span<const std::uint32_t> order, std::uint32_t per_step) {
    const auto batch = log.begin() + std::ptrdiff_t{first} * per_step;
    const auto count = static_cast<std::ptrdiff_t>(order.size()) * per_step;
    const std::vector<T> logged(batch, batch + count);
    auto to = batch;
    for (const std::uint32_t step : order) {
      to = std::copy_n(logged.begin() + std::ptrdiff_t{step} * per_step, per_step, to);
    }
  }

  HalfEdgeMesh mesh_;
  std::vector<Vec3d> positions_;  // a removed vertex keeps its last
  MetricFrame frame_;
  BorderLoops borders_;
  CollapseLog log_;

  // Once ids are compact: those of the input by them, and what there was.
  std::vector<VertexId> names_;
  std::vector<FaceId> face_names_;
  std::uint32_t input_faces_ = 0;
  std::vector<Vec3d> input_positions_;
};

}  // namespace pmesh
