// Decimation: takes vertices out of a mesh by half-edge collapses, the least important first, and
// logs them.
//
// Every state on the way is an oriented 2-manifold of the input's topology: the link condition is
// always kept, border vertices move along their border only, a closed component ends as a
// tetrahedron, an open one as a triangle. No collapse turns a face by more than 90 degrees, unless
// the target cannot be had otherwise (see DecimationReport).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/decimate/collapse_log.h"
#include "core/decimate/working_mesh.h"
#include "core/mesh/half_edge_mesh.h"
#include "core/metrics/table.h"

namespace pmesh {

/// In which order candidates are collapsed.
enum class Schedule : std::uint8_t {
  /// In batches of collapses that do not meet, the cheaper ones first where they do. What a
  /// progressive file is made of: it codes far better than the exact order, for a few percent more
  /// error at the same number of faces (docs/decisions/0012).
  ///
  /// Among the steps (collapses; for triangle collapses pairs of them) of one batch
  ///  - no two remove vertices that are neighbours in the mesh at the batch's start: no face has
  ///    two corners that are removed by different steps;
  ///  - no two keep the same vertex, and none keeps what another removes;
  ///  - so each is worth what it was worth at the batch's start, and they are legal in any order.
  /// They are logged in ascending order of their keys.
  batched,
  /// Greedy, the cheapest of the moment by a heap, as the metrics' papers have it.
  exact,
};

struct DecimateOptions {
  AnyMetric metric;
  Schedule schedule = Schedule::batched;
  /// Stops at the first mesh of at most this many faces.
  std::uint32_t base_faces = 200;
  /// For evaluations: in batches all, in exact order the first of all vertices. The result does not
  /// depend on it. At least 1.
  unsigned threads = 1;
  /// By vertex: nonzero if the vertex must be neither removed nor moved. Empty: none is locked.
  std::span<const std::uint8_t> locked;
  /// Called now and then, on the calling thread, with the collapses made and an estimate of all.
  std::function<void(std::uint64_t done, std::uint64_t total_guess)> progress;
  /// If given, always holds the current phase, for a profiler that samples it from another thread.
  std::atomic<DecimationPhase>* phase = nullptr;
};

struct DecimationReport {
  std::uint32_t faces = 0;  ///< Of the decimated mesh.
  std::uint32_t vertices = 0;
  /// The faces that were left when no triangle passed the metric's planar test any more, if others
  /// were then collapsed.
  std::optional<std::uint32_t> planarity_relaxed_at_faces;
  /// The faces that were left when no collapse without fold-over remained, if collapses with
  /// fold-over were then made.
  std::optional<std::uint32_t> fold_over_relaxed_at_faces;
};

struct Decimation {
  HalfEdgeMesh mesh;  ///< The base: live faces and vertices in the ids of the input.
  CollapseLog log;
  /// By vertex: where it is in the base, or where it was when it was removed.
  std::vector<Vec3d> positions;
  DecimationReport report;
};

/// Decimates `mesh`, whose vertex v lies at positions[v]. Needs about 120 bytes a vertex besides
/// the mesh and its positions, and what the metric keeps. The same log for the same input, whatever
/// the threads; O(n log n). Precondition: positions.size() == mesh.vertex_slots(), all finite.
Decimation decimate(HalfEdgeMesh mesh, std::vector<Vec3d> positions,
                    const DecimateOptions& options = {});

}  // namespace pmesh
