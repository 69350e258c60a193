// Distances from a surface to another, at sampled points.
#pragma once

#include "core/measure/bound_memory.h"
#include "core/measure/sampling.h"
#include "core/measure/surface.h"

namespace pmesh {

/// From one surface to another: in the meshes' units or in unit lengths.
struct SurfaceDistance {
  double max = 0, mean = 0, rms = 0;
};

/// Over the sampler's points, or all vertices of `source`, in unit lengths; zeros if there are
/// none. Deterministic, whatever the threads. `memory`, if not null, knows where to begin.
SurfaceDistance sampled_distance(const Surface& source, const SurfaceSampler& sampler,
                                 const Surface& target, unsigned threads,
                                 const BoundMemory* memory = nullptr);
SurfaceDistance vertex_distance(const Surface& source, const Surface& target, unsigned threads);

}  // namespace pmesh
