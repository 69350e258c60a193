#include "core/io/single_precision.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmesh {

double largest_coordinate(const Lattice& lattice) {
  const double extent = lattice.step * (std::ldexp(1.0, lattice.bits) - 1);
  double largest = 0;
  for (const double low : {lattice.origin.x, lattice.origin.y, lattice.origin.z}) {
    largest = std::max({largest, std::abs(low), std::abs(low + extent)});
  }
  return largest;
}

double float_rounding(double largest) {
  if (largest == 0) return 0;
  // Half the gap between neighbouring floats of that size.
  const int exponent = std::max(std::ilogb(largest), std::numeric_limits<float>::min_exponent - 1);
  return std::ldexp(0.5, exponent + 1 - std::numeric_limits<float>::digits);
}

bool fits_single_precision(const Lattice& lattice) {
  const double largest = largest_coordinate(lattice);
  if (!(largest <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
  return float_rounding(largest) <= lattice.step / 8;
}

Vec3<float> to_single(Vec3d p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

}  // namespace pmesh
