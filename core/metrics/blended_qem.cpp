#include "core/metrics/blended_qem.h"

#include <algorithm>

namespace pmesh {

BlendedQem::Prepared BlendedQem::prepare(const OneRing& ring) const {
  Quadric cost = remembered_[ring.centre].relative_to(ring.origin).scaled(memory_);
  for (std::uint32_t i = 0; i < ring.faces; ++i) {
    cost += Quadric::plane({ring.nx[i], ring.ny[i], ring.nz[i]}, 0, ring.area[i]);
  }
  if (ring.border) {
    cost += Quadric::squared_area({}, ring.position(0));
    cost += Quadric::squared_area(ring.position(ring.neighbours - 1), {});
  }
  return {cost};
}

double BlendedQem::cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
                        const MovedFaces& /*moved*/) const {
  return std::max(0.0, prepared.cost(ring.position(head)));
}

}  // namespace pmesh
