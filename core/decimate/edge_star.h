// Gathers the geometry that metrics of edges and the fold-over check read (see edge_metric.h).
#pragma once

#include "core/decimate/edge_metric.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// The edge from `a` to `b` with the apexes of its faces, given in the mesh's own frame.
inline PlacedEdge place_edge(const MetricFrame& frame, Vec3d a, Vec3d b, Vec3d left, Vec3d right,
                             bool on_border) {
  const Vec3d middle = 0.5 * (a + b), half = 0.5 * frame.scale * (b - a);
  return {-1.0 * half, half, frame.scale * (left - middle), frame.scale * (right - middle),
          on_border};
}

/// Fills in `star`, but for what gather_star() adds, for the edge of `half_edge`.
void gather_ends(const WorkingMesh& work, HalfEdgeId half_edge, EdgeStar& star);

/// Fills in the rest. False if an end has more than EdgeStar::kMaxFaces faces; the walk stops
/// there.
bool gather_star(const WorkingMesh& work, EdgeStar& star);

/// False if `v` has more than OneRing::kMaxFaces faces; the walk stops there.
bool gather_ring(const WorkingMesh& work, VertexId v, PlacedRing& ring);

/// Whether a surviving face of `star` turns by more than 90 degrees or loses its area, once its end
/// is at `position`. Faces without area to begin with do not count.
bool folds_over(const EdgeStar& star, Vec3d position);

}  // namespace pmesh
