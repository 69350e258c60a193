#include "core/decimate/engine.h"

namespace pmesh {

double unit_scale(std::span<const Vec3d> positions) {
  if (positions.empty()) return 1;
  Vec3d low = positions[0], high = positions[0];
  for (const Vec3d& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const double scale = 1 / length(high - low);
  return std::isfinite(scale) ? scale : 1;
}

}  // namespace pmesh
