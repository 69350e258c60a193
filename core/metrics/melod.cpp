#include "core/metrics/melod.h"

#include <algorithm>

namespace pmesh {
namespace {

Vec3d unit(Vec3d v) {
  const double norm = length(v);
  return norm > 0 ? 1 / norm * v : Vec3d{};
}

}  // namespace

double Melod::cost(const OneRing& ring, Prepared, std::uint32_t head,
                   const MovedFaces& moved) const {
  double cost = 0;
  const double* const area = ring.area.data() + moved.first;
  for (std::uint32_t k = 0; k < moved.count; ++k) {
    cost += 0.5 * (area[k] + moved.area[k]) * (1 - moved.cosine[k]);
  }
  if (ring.border) cost += lambda_ * border_turn(ring, head) * length(ring.position(head));
  return cost;
}

double Melod::importance(const OneRing& ring) {
  Vec3d sum;
  double total = 0;
  for (std::uint32_t i = 0; i < ring.faces; ++i) {
    sum += ring.area[i] * Vec3d{ring.nx[i], ring.ny[i], ring.nz[i]};
    total += ring.area[i];
  }
  return total > 0 ? std::max(0.0, 1 - length(sum) / total) : 0;
}

double Melod::border_turn(const OneRing& ring, std::uint32_t head) {
  const Vec3d v2 = ring.position(head);
  const Vec3d v3 = head == 0 ? ring.beyond_first : ring.beyond_last;
  return 1 - dot(unit(-1.0 * v2), unit(v3 - v2));
}

}  // namespace pmesh
