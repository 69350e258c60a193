#include "core/precompute/quantise.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace pmesh {
namespace {

using Corner = std::array<std::int32_t, 3>;
using PlacedTriangle = std::array<Corner, 3>;

// The triangles by position, each starting at its smallest corner, in order.
std::vector<PlacedTriangle> placed_triangles(const LatticeMesh& mesh) {
  std::vector<PlacedTriangle> placed;
  placed.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    PlacedTriangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3i p = mesh.positions[t[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    PlacedTriangle smallest = corners;
    for (int turn = 0; turn < 2; ++turn) {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      smallest = std::min(smallest, corners);
    }
    placed.push_back(smallest);
  }
  std::sort(placed.begin(), placed.end());
  return placed;
}

}  // namespace

Result<Lattice> choose_lattice(const IndexedMesh& mesh, const std::vector<Vec3d>& reach,
                               const Precision& precision) {
  assert(!precision.bits || !precision.tolerance);
  if (precision.bits) return make_lattice(reach, *precision.bits);
  if (precision.tolerance) return make_lattice_within(reach, *precision.tolerance);
  int fewer = default_lattice_bits(mesh);
  Result<Lattice> lattice = make_lattice(reach, fewer);
  while (!lattice && fewer > kMinLatticeBits) lattice = make_lattice(reach, --fewer);
  return lattice;
}

std::vector<Vec3i> quantise(const std::vector<Vec3d>& positions, const Lattice& lattice) {
  std::vector<Vec3i> points;
  points.reserve(positions.size());
  for (const Vec3d p : positions) points.push_back(lattice.quantise(p));
  return points;
}

bool same_triangles(const LatticeMesh& a, const LatticeMesh& b) {
  return a.triangles.size() == b.triangles.size() && placed_triangles(a) == placed_triangles(b);
}

}  // namespace pmesh
