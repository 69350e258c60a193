// The distance between two surfaces, both ways (P. Cignoni, C. Rocchini, R. Scopigno, Metro:
// measuring error on simplified surfaces, Computer Graphics Forum 17(2), 1998).
//
// The one-sided distance from A to B looks at points of A and takes each one's distance to the
// nearest point of B, exactly:
//  - mean and root mean square (rms) over points spread evenly over A's area;
//  - max over those, over points spread along A's edges, over A's vertices, and over points that a
//    search goes on to where more may be found (core/measure/distance_bound.h), until none can be
//    farther by more than 2%.
// Faces with two corners in one place are measured to, not from (core/measure/surface.h).
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/measure/sampled_distance.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

struct CompareOptions {
  /// Points a direction, three in four over faces, one in four along edges; vertices besides.
  std::uint32_t samples = 1'000'000;
  std::uint64_t seed = 0;
  unsigned threads = 1;  ///< The result does not depend on it.
};

struct Comparison {
  double bbox_diagonal = 0;  ///< Of A's bounding box: what relative values are relative to.
  SurfaceDistance forward;   ///< From A to B.
  SurfaceDistance backward;  ///< From B to A.

  /// The larger of both directions.
  double max() const { return forward.max > backward.max ? forward.max : backward.max; }
  double rms() const { return forward.rms > backward.rms ? forward.rms : backward.rms; }
};

/// Fails (bad_input) if a mesh has no triangle, or if the two are too large to be measured.
/// Preconditions: indices are in range, positions finite. Unused vertices do not count. About 100
/// bytes a face beside the meshes.
Result<Comparison> compare_surfaces(const IndexedMesh& a, const IndexedMesh& b,
                                    const CompareOptions& options);

}  // namespace pmesh
