// A mesh renumbered so that what is near in space is near in memory: decimation is bound by cache
// misses.
#pragma once

#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// Numbers the vertices along a Hilbert curve, and the faces by their least vertex. The faces keep
/// their geometry, their orientation and where they start. The result does not depend on `threads`.
void sort_spatially(IndexedMesh& mesh, unsigned threads);

}  // namespace pmesh
