// Distances from a surface to another, at sampled points.
#pragma once

#include <cstdint>
#include <vector>

#include "core/measure/sampling.h"
#include "core/measure/surface.h"

namespace pmesh {

/// From one surface to another: in the meshes' units or in unit lengths.
struct SurfaceDistance {
  double max = 0, mean = 0, rms = 0;
};

/// Over the sampler's points, or all vertices of `source`, in unit lengths; zeros if there are
/// none. Deterministic, whatever the threads. `near`, if not null, is by sample: a face of the
/// target to begin with, or kNoIndex; and the nearest one afterwards.
SurfaceDistance sampled_distance(const Surface& source, const SurfaceSampler& sampler,
                                 const Surface& target, unsigned threads,
                                 std::vector<std::uint32_t>* near = nullptr);
SurfaceDistance vertex_distance(const Surface& source, const Surface& target, unsigned threads);

}  // namespace pmesh
