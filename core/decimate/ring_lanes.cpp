#include "core/decimate/ring_lanes.h"

#include "core/decimate/lanes.h"

namespace pmesh {

PMESH_WIDE_VECTORS
LaneChoices choose_heads(const RingLanes& rings, const LaneCosts& costs, double negligible) {
  const Lanes none = Lanes{} + kRefused, one = Lanes{} + 1.0;
  Lanes count, least = none, best{}, sum_x{}, sum_y{}, sum_z{}, squares{};
  for (std::size_t l = 0; l < RingLanes::kLanes; ++l) count[l] = rings.count[l];
  Lanes row{};
  for (std::uint32_t i = 0; i < rings.rows; ++i, row += one) {
    const auto is_head = row < count;
    const Lanes x = is_head ? lanes_of(rings.x[i]) : Lanes{};
    const Lanes y = is_head ? lanes_of(rings.y[i]) : Lanes{};
    const Lanes z = is_head ? lanes_of(rings.z[i]) : Lanes{};
    const Lanes cost = is_head ? lanes_of(costs[i]) : none;
    best = cost < least ? row : best;
    least = cost < least ? cost : least;
    sum_x += x, sum_y += y, sum_z += z;
    squares += x * x + y * y + z * z;
  }
  const Lanes mean = squares / count;
  const Lanes most = least + negligible * mean * mean;
  Lanes alike{};
  row = Lanes{};
  for (std::uint32_t i = 0; i < rings.rows; ++i, row += one) {
    const Lanes cost = row < count ? lanes_of(costs[i]) : none;
    alike += cost <= most ? one : Lanes{};
  }
  const Lanes off = (sum_x * sum_x + sum_y * sum_y + sum_z * sum_z) / (count * count);
  const Lanes spread = squares / count - off;
  const Lanes off_centre = spread > 0.0 ? off / spread : Lanes{};
  LaneChoices choices;
  lanes_of(choices.best) = best;
  lanes_of(choices.most) = most;
  lanes_of(choices.alike) = alike;
  lanes_of(choices.off_centre) = off_centre;
  return choices;
}

}  // namespace pmesh
