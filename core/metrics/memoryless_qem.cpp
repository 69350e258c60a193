#include "core/metrics/memoryless_qem.h"

#include <algorithm>

namespace pmesh {

MemorylessQem::Prepared MemorylessQem::prepare(const OneRing& ring) const {
  Prepared prepared;
  for (std::uint32_t i = 0; i < ring.faces; ++i) {
    prepared.planes += Quadric::plane({ring.nx[i], ring.ny[i], ring.nz[i]}, 0, ring.area[i]);
  }
  if (ring.border) {
    prepared.planes += Quadric::squared_area({}, ring.position(0));
    prepared.planes += Quadric::squared_area(ring.position(ring.neighbours - 1), {});
  }
  return prepared;
}

double MemorylessQem::cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
                           const MovedFaces& /*moved*/) const {
  return std::max(0.0, prepared.planes(ring.position(head)));
}

}  // namespace pmesh
