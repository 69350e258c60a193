#include "core/mesh/lattice.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
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

double last_coordinate(int bits) { return std::ldexp(1.0, bits) - 1; }

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

Result<Box<double>> finite_box(const std::vector<Vec3d>& positions) {
  if (!std::all_of(positions.begin(), positions.end(), is_finite)) {
    return bad_input("a position is not finite");
  }
  const Box<double> box = bounding_box(std::span(positions));
  if (!std::isfinite(box.longest_side())) return bad_input("the bounding box is not finite");
  return box;
}

// `lattice`, if doubles in `box` can tell its points apart.
Result<Lattice> checked(const Lattice& lattice, const Box<double>& box) {
  const double largest = largest_coordinate(box);
  const double resolution = largest - std::nextafter(largest, 0);
  if (box.longest_side() > 0 &&
      (lattice.step < resolution || lattice.step < std::numeric_limits<double>::min())) {
    return bad_input("quantisation to " + std::to_string(lattice.bits) +
                     " bits is finer than double precision at these coordinates");
  }
  return lattice;
}

std::string three_digits(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 3);
  return {text.data(), end.ptr};
}

Error too_fine(double tolerance, double side) {
  const std::string most = std::to_string(kMaxLatticeBits);
  return bad_input("a tolerance of " + three_digits(tolerance) + " takes more than " + most +
                   " bits a coordinate; at " + most + " bits it is " +
                   three_digits(0.5 * side / last_coordinate(kMaxLatticeBits)));
}

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
  const double last = last_coordinate(bits);
  const auto nearest = [&](double value, double low) {
    return static_cast<std::int32_t>(std::clamp(std::round((value - low) / step), 0.0, last));
  };
  return {nearest(position.x, origin.x), nearest(position.y, origin.y),
          nearest(position.z, origin.z)};
}

Result<Lattice> make_lattice(const std::vector<Vec3d>& positions, int bits) {
  assert(!positions.empty() && bits >= kMinLatticeBits && bits <= kMaxLatticeBits);
  const Result<Box<double>> box = finite_box(positions);
  if (!box) return box.error();
  const double side = box->longest_side();
  return checked(
      {box->low, side > 0 ? side / last_coordinate(bits) : 1, static_cast<std::uint8_t>(bits)},
      *box);
}

Result<Lattice> make_lattice_within(const std::vector<Vec3d>& positions, double tolerance) {
  assert(!positions.empty() && std::isfinite(tolerance) && tolerance > 0);
  const Result<Box<double>> box = finite_box(positions);
  if (!box) return box.error();
  const double side = box->longest_side();
  if (side == 0 || tolerance >= 0.5 * side / last_coordinate(kMinLatticeBits)) {
    return make_lattice(positions, kMinLatticeBits);
  }
  const double step = 2 * tolerance;
  int bits = kMinLatticeBits;
  while (step * last_coordinate(bits) < side) {
    if (++bits > kMaxLatticeBits) return too_fine(tolerance, side);
  }
  return checked({box->low, step, static_cast<std::uint8_t>(bits)}, *box);
}

int default_lattice_bits(const IndexedMesh& mesh) {
  constexpr int kFewest = 10, kMost = 20;
  constexpr double kStepsPerEdge = 24;
  if (mesh.triangles.empty()) return kFewest;
  const double side = bounding_box(std::span(mesh.positions)).longest_side();
  if (!(side > 0)) return kFewest;
  const double edge = median_edge_length(mesh, side);
  int bits = kFewest;
  while (bits < kMost && kStepsPerEdge / last_coordinate(bits) > edge) ++bits;
  return bits;
}

}  // namespace pmesh
