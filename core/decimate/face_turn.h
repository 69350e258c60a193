// How a face turns when one of its corners moves.
#pragma once

#include <algorithm>

#include "core/base/vec3.h"
#include "core/decimate/one_ring.h"

namespace pmesh {

/// Whether a face of that doubled area vector and those two sides has a usable normal, as
/// gather_faces() has it.
inline bool has_area(Vec3d doubled_area, Vec3d side, Vec3d other_side) {
  const double limit = kZeroAreaRatio * std::max(dot(side, side), dot(other_side, other_side));
  return length(doubled_area) > limit;
}

/// Whether the face (corner, second, third) turns by more than the angle of `least_cosine`, or
/// loses its area, once its corner is at `moved`. Faces without area to begin with do not count.
inline bool turns(Vec3d corner, Vec3d second, Vec3d third, Vec3d moved, double least_cosine) {
  const Vec3d old_second = second - corner, old_third = third - corner;
  const Vec3d new_second = second - moved, new_third = third - moved;
  const Vec3d before = cross(old_second, old_third), after = cross(new_second, new_third);
  if (!has_area(before, old_second, old_third)) return false;
  return !has_area(after, new_second, new_third) ||
         dot(before, after) < least_cosine * length(before) * length(after);
}

}  // namespace pmesh
