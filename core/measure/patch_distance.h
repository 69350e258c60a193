// A bound on how far a few faces are from a few others, whatever their shapes: for the odd cases of
// core/measure/collapse_gap.h, where faces fold over.
#pragma once

#include <span>

#include "core/measure/surface.h"

namespace pmesh {

/// No point of `faces` is farther than this from the nearest of `others` and `more`, or than
/// `limit`, which is known to bound it. Sharp, to within a factor of 1.5 or so, if these lie like
/// tiles below and above the faces, and there are few of them, or `effort` is large: time grows
/// with it.
double patch_distance(std::span<const Corners> faces, std::span<const Corners> others,
                      std::span<const Corners> more, double limit, int effort = 1);

}  // namespace pmesh
