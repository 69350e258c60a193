// What decimation hands to the encoder: the collapses in the order they were made.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Collapses of a mesh, first to last, in the vertex ids of the mesh that was decimated. Replayed
/// backwards as vertex splits they rebuild it from its base.
struct CollapseLog {
  std::vector<HalfEdgeCollapse> collapses;

  /// Where the metric places the kept vertex freely: by collapse, the position that its kept vertex
  /// had before it, as long as `collapses`. Empty where kept vertices stay where they are.
  std::vector<Vec3d> kept_before;

  /// Collapses that belong together: 2 if the metric collapses triangles, each as two half-edge
  /// collapses; else 1. The log's length is a multiple of it, and no chunk ends within a step.
  std::uint32_t collapses_per_step = 1;

  /// Where the schedule is batched: by batch, how many collapses there were at its end, ascending,
  /// the last collapses.size(). Empty where it is exact. (See Schedule in decimate.h for what a
  /// batch is.)
  std::vector<std::uint32_t> batch_ends;
};

}  // namespace pmesh
