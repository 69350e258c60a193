// Integer arithmetic of the split codec: the same result on every machine and in every language
// with 53-bit integers. docs/pm-format.md, "Arithmetic", specifies each function.
#pragma once

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "core/base/vec3.h"

namespace pmesh {

using Vec3l = Vec3<std::int64_t>;

/// a / b rounded to the nearest integer, halves up. Precondition: b > 0.
inline std::int64_t divide(std::int64_t a, std::int64_t b) {
  assert(b > 0);
  const std::int64_t twice = 2 * a + b;
  const std::int64_t quotient = twice / (2 * b);
  return quotient - static_cast<std::int64_t>(twice % (2 * b) < 0);
}

inline Vec3l divide(Vec3l a, std::int64_t b) {
  return {divide(a.x, b), divide(a.y, b), divide(a.z, b)};
}

/// Bits of |value|: 0 for 0, 1 for 1, 2 for 2 and 3, ...
inline int bit_length(std::int64_t value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value < 0 ? -value : value)));
}

/// The integer part of the square root. Precondition: 0 <= value < 2^52, where the double's own
/// root, rounded correctly as IEEE 754 demands, cannot reach the next integer.
inline std::int64_t square_root(std::int64_t value) {
  assert(value >= 0 && value < std::int64_t{1} << 52);
  return static_cast<std::int64_t>(std::sqrt(static_cast<double>(value)));
}

/// Twice the logarithm to base 2, roughly: 0 for 0, else 2 bit_length, plus 1 if the bit below the
/// leading one is set.
inline int half_octaves(std::int64_t value) {
  const int bits = bit_length(value);
  return bits < 2 ? 2 * bits : 2 * bits + static_cast<int>(value >> (bits - 2) & 1);
}

/// |x| + |y| + |z|.
template <class T>
std::int64_t manhattan(Vec3<T> a) {
  return std::int64_t{std::abs(a.x)} + std::abs(a.y) + std::abs(a.z);
}

/// The largest of |x|, |y| and |z|.
inline std::int64_t largest(Vec3l a) {
  std::int64_t most = std::abs(a.x);
  if (std::abs(a.y) > most) most = std::abs(a.y);
  return std::abs(a.z) > most ? std::abs(a.z) : most;
}

inline Vec3l shift_right(Vec3l a, int bits) { return {a.x >> bits, a.y >> bits, a.z >> bits}; }

inline std::int64_t clamp_to(std::int64_t value, std::int64_t most) {
  return value < -most ? -most : value > most ? most : value;
}
inline Vec3l clamp_to(Vec3l a, std::int64_t most) {
  return {clamp_to(a.x, most), clamp_to(a.y, most), clamp_to(a.z, most)};
}

}  // namespace pmesh
