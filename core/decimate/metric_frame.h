// The frame in which metrics measure: the whole mesh's bounding box has its centre in the origin
// and a diagonal of length one. So no result depends on the mesh's unit or on where it lies.
#pragma once

#include <span>

#include "core/base/vec3.h"

namespace pmesh {

struct MetricFrame {
  Vec3d centre;
  double scale = 1;  ///< One over the bounding box's diagonal; 1 if that is not a positive number.

  Vec3d to_unit(Vec3d position) const { return scale * (position - centre); }
  Vec3d from_unit(Vec3d unit) const { return centre + 1 / scale * unit; }
};

MetricFrame metric_frame(std::span<const Vec3d> positions);

}  // namespace pmesh
