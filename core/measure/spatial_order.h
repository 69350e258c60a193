// Points in the order of a Hilbert curve, so that neighbours in the order are neighbours in space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace pmesh {

/// The ranks' order: result[i] is the index of the i-th point along the curve; points in one cell
/// of its 2^48 over [-1, 1]^3 keep their order. Points outside are taken to the cube. O(n).
std::vector<std::uint32_t> spatial_order(std::span<const Vec3d> points, unsigned threads);

}  // namespace pmesh
