#include "core/mesh/lattice.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

namespace pmesh {
namespace {

struct Box {
  Vec3d low, high;

  double longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
  double largest_coordinate() const {
    return std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x),
                     std::abs(high.y), std::abs(high.z)});
  }
};

Box bounding_box(const std::vector<Vec3d>& positions) {
  Box box{positions.front(), positions.front()};
  for (const Vec3d& p : positions) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

double median_edge_length(const IndexedMesh& mesh) {
  std::vector<double> squared;
  squared.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3d edge = mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]];
      squared.push_back(dot(edge, edge));
    }
  }
  if (squared.empty()) return 0;
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
  const Box box = bounding_box(positions);
  const double side = box.longest_side();
  if (!std::isfinite(side)) return bad_input("the bounding box is not finite");
  Lattice lattice{box.low, side / (std::ldexp(1.0, bits) - 1), static_cast<std::uint8_t>(bits)};
  if (side == 0) lattice.step = 1;
  const double largest = box.largest_coordinate();
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
  const double edge = median_edge_length(mesh);
  const double side = mesh.positions.empty() ? 0 : bounding_box(mesh.positions).longest_side();
  int bits = kFewest;
  while (bits < kMost && side / (std::ldexp(1.0, bits) - 1) * kStepsPerEdge > edge) ++bits;
  return bits;
}

}  // namespace pmesh
