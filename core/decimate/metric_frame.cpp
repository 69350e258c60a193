#include "core/decimate/metric_frame.h"

#include <cmath>

#include "core/base/box.h"

namespace pmesh {

MetricFrame metric_frame(std::span<const Vec3d> positions) {
  if (positions.empty()) return {};
  const Box<double> box = bounding_box(positions);
  const double side = box.longest_side();
  const Vec3d diagonal = box.high - box.low;  // in units of the side it can be squared
  const Vec3d relative{diagonal.x / side, diagonal.y / side, diagonal.z / side};
  const double scale = 1 / (side * length(relative));
  const Vec3d centre = box.low + 0.5 * diagonal;
  return {centre, std::isfinite(scale) && scale > 0 ? scale : 1};
}

}  // namespace pmesh
