// The one grid of integer positions that a PM file uses: position = origin + step * integer.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/result.h"
#include "core/base/vec3.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

inline constexpr int kMinLatticeBits = 4;
inline constexpr int kMaxLatticeBits = 30;

struct Lattice {
  Vec3d origin;           ///< The position of (0, 0, 0), in the mesh's units.
  double step = 1;        ///< The distance of neighbouring integers, the same on all axes; > 0.
  std::uint8_t bits = 0;  ///< Every coordinate lies in [0, 2^bits).

  Vec3d position(Vec3i point) const {
    return {origin.x + step * point.x, origin.y + step * point.y, origin.z + step * point.z};
  }
  /// The nearest lattice point; `position` must lie in the box that the lattice was made for.
  Vec3i quantise(Vec3d position) const;

  friend bool operator==(const Lattice&, const Lattice&) = default;
};

/// The lattice of `bits` bits over the bounding box of `positions`: the longest side spans
/// 2^bits - 1 steps. Fails if the box or a position is not finite, or the box too small to be
/// divided in doubles (a step must be at least one unit in the last place of the largest
/// coordinate). Precondition: positions is not empty, kMinLatticeBits <= bits <= kMaxLatticeBits.
Result<Lattice> make_lattice(const std::vector<Vec3d>& positions, int bits);

/// The coarsest lattice over that box which moves no coordinate of `positions` by more than
/// `tolerance` (doubles' own rounding apart): its step is twice the tolerance, or that of
/// kMinLatticeBits bits if that is finer. Fails as above, or if it would take more than
/// kMaxLatticeBits. Precondition: positions is not empty, tolerance is finite and > 0.
Result<Lattice> make_lattice_within(const std::vector<Vec3d>& positions, double tolerance);

/// The default precision: the fewest bits, 10 to 20, whose step is at most 1/24 of the median
/// edge length of `mesh` (about one degree of noise in a normal).
int default_lattice_bits(const IndexedMesh& mesh);

}  // namespace pmesh
