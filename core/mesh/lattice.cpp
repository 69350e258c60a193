#include "core/mesh/lattice.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "core/base/box.h"

namespace pmesh {
namespace {

double largest_coordinate(const Box<double>& box) {
  return std::max({std::abs(box.low.x), std::abs(box.low.y), std::abs(box.low.z),
                   std::abs(box.high.x), std::abs(box.high.y), std::abs(box.high.z)});
}

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// In units of `side`, so that no mesh is too large or small for its edges to be squared.
double median_edge_length(const IndexedMesh& mesh, double side) {
  std::vector<double> squared;
  squared.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d edge = mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]];
      const Vec3d relative{edge.x / side, edge.y / side, edge.z / side};
      squared.push_back(dot(relative, relative));
    }
  }
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  return std::sqrt(*middle);
}

}  // namespace

Vec3i Lattice::quantise(Vec3d position) const {
  const double last = std::ldexp(1.0, bits) - 1;
  const auto nearest = [&](double value, double low) {
    return static_cast<std::int32_t>(std::clamp(std::round((value - low) / step), 0.0, last));
  };
  return {nearest(position.x, origin.x), nearest(position.y, origin.y),
          nearest(position.z, origin.z)};
}

Result<Lattice> make_lattice(const std::vector<Vec3d>& positions, int bits) {
  assert(!positions.empty() && bits >= kMinLatticeBits && bits <= kMaxLatticeBits);
  if (!std::all_of(positions.begin(), positions.end(), is_finite)) {
    return bad_input("a position is not finite");
  }
  const Box<double> box = bounding_box(std::span(positions));
  const double side = box.longest_side();
  if (!std::isfinite(side)) return bad_input("the bounding box is not finite");
  Lattice lattice{box.low, side / (std::ldexp(1.0, bits) - 1), static_cast<std::uint8_t>(bits)};
  if (side == 0) lattice.step = 1;
  const double largest = largest_coordinate(box);
  const double resolution = largest - std::nextafter(largest, 0);
  if (side > 0 &&
      (lattice.step < resolution || lattice.step < std::numeric_limits<double>::min())) {
    return bad_input("quantisation to " + std::to_string(bits) +
                     " bits is finer than double precision at these coordinates");
  }
  return lattice;
}

int default_lattice_bits(const IndexedMesh& mesh) {
  constexpr int kFewest = 10, kMost = 20;
  constexpr double kStepsPerEdge = 24;
  if (mesh.triangles.empty()) return kFewest;
  const double side = bounding_box(std::span(mesh.positions)).longest_side();
  if (!(side > 0)) return kFewest;
  const double edge = median_edge_length(mesh, side);
  int bits = kFewest;
  while (bits < kMost && kStepsPerEdge / (std::ldexp(1.0, bits) - 1) > edge) ++bits;
  return bits;
}

}  // namespace pmesh
