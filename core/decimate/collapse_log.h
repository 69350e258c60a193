// What decimation hands to the encoder: the collapses in the order they were made.
#pragma once

#include <vector>

#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// Collapses of a mesh, first to last, in the vertex ids of the mesh that was decimated. Replayed
/// backwards as vertex splits they rebuild it from its base.
struct CollapseLog {
  std::vector<HalfEdgeCollapse> collapses;
};

}  // namespace pmesh
