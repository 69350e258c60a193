#include "core/precompute/displacements.h"

#include <algorithm>
#include <bit>

namespace pmesh {
namespace {

std::uint64_t hash_of(Vec3i point) {
  const auto part = [](std::int32_t value, std::uint64_t factor) {
    return static_cast<std::uint32_t>(value) * factor;
  };
  const std::uint64_t sum = part(point.x, 0x9E37'79B9'7F4A'7C15u) +
                            part(point.y, 0xC2B2'AE3D'27D4'EB4Fu) +
                            part(point.z, 0x1656'67B1'9E37'79F9u);
  return sum ^ (sum >> 32);
}

}  // namespace

Displacements::Displacements(const IndexedMesh& original, const Lattice& lattice)
    : entries_(std::bit_ceil(2 * original.positions.size() + 1)) {
  const ExportedPositions exported(lattice);
  for (const Vec3d p : original.positions) {
    const Vec3i point = lattice.quantise(p);
    Entry& entry = entries_[slot_of(point)];
    entry = {point, std::max(entry.length, length(exported(point) - p))};
  }
}

std::size_t Displacements::slot_of(Vec3i point) const {
  const std::size_t mask = entries_.size() - 1;
  std::size_t slot = hash_of(point) & mask;
  while (entries_[slot].length != kFree && entries_[slot].point != point) slot = (slot + 1) & mask;
  return slot;
}

}  // namespace pmesh
