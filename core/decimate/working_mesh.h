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

  /// Collapses `edge` as HalfEdgeMesh::collapse() does; the kept vertex stays where it is.
  void collapse(VertexId removed, HalfEdgeId edge) {
    if (mesh_.is_border(removed)) borders_.remove(removed);
    log_.collapses.push_back(mesh_.collapse(removed, edge));
  }

  /// The same, and places the kept vertex at `position`.
  void collapse(VertexId removed, HalfEdgeId edge, Vec3d position) {
    if (log_.kept_before.empty()) log_.kept_before.reserve(log_.collapses.capacity());
    collapse(removed, edge);
    Vec3d& kept = positions_[log_.collapses.back().kept.value];
    log_.kept_before.push_back(kept);
    kept = position;
  }

  /// Ends a batch of steps of `per_step` collapses, and puts what it has logged into another order:
  /// by new place, the step's old place in the batch.
  void end_batch(std::span<const std::uint32_t> order, std::uint32_t per_step) {
    reorder(log_.collapses, order, per_step);
    if (!log_.kept_before.empty()) reorder(log_.kept_before, order, per_step);
    log_.batch_ends.push_back(static_cast<std::uint32_t>(log_.collapses.size()));
  }

  /// Asks for what there is of `v` to be brought into the caches.
  void prefetch(VertexId v) const {
    mesh_.prefetch(v);
    __builtin_prefetch(&positions_[v.value]);
  }

  HalfEdgeMesh take_mesh() { return std::move(mesh_); }
  std::vector<Vec3d> take_positions() { return std::move(positions_); }
  CollapseLog take_log() { return std::move(log_); }

 private:
  template <class T>
  static void reorder(std::vector<T>& log, std::span<const std::uint32_t> order,
                      std::uint32_t per_step) {
    const auto batch = log.end() - static_cast<std::ptrdiff_t>(order.size() * per_step);
    const std::vector<T> logged(batch, log.end());
    auto to = batch;
    for (const std::uint32_t step : order) {
      to = std::copy_n(logged.begin() + std::size_t{step} * per_step, per_step, to);
    }
  }

  HalfEdgeMesh mesh_;
  std::vector<Vec3d> positions_;  // a removed vertex keeps its last
  MetricFrame frame_;
  BorderLoops borders_;
  CollapseLog log_;
};

}  // namespace pmesh
