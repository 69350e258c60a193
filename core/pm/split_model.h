// What the split coder and decoder share: how many bits each number takes. docs/pm-format.md
// section "Chunk" specifies it. Split codec 0: plain records packed in bits.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/base/vec3.h"

namespace pmesh {

/// Bits that name one of `count` things.
inline int bits_for(std::uint32_t count) { return static_cast<int>(std::bit_width(count - 1)); }

/// Exp-Golomb parameter of the number of moved faces (half of all vertices move three to five).
inline constexpr int kMovedFacesOrder = 2;

/// Chooses the Rice parameter of a coordinate difference from the mean of the earlier ones.
class RiceModel {
 public:
  explicit RiceModel(int lattice_bits) : scaled_mean_(kScale << std::max(0, lattice_bits - 4)) {}

  int parameter() const {
    return std::max(0, static_cast<int>(std::bit_width(scaled_mean_ / kScale)) - 1);
  }
  void update(std::uint32_t value) {
    scaled_mean_ += std::min(value, kLargest) - scaled_mean_ / kScale;
  }

 private:
  static constexpr std::uint32_t kScale = 16;          // the mean is taken over about 16 values
  static constexpr std::uint32_t kLargest = 1u << 27;  // so that scaled_mean_ cannot overflow
  std::uint32_t scaled_mean_;
};

/// A model for each axis.
using PointModel = std::array<RiceModel, 3>;
inline PointModel make_point_model(int lattice_bits) {
  const RiceModel model(lattice_bits);
  return {model, model, model};
}

/// Where a kept vertex is expected after its split: merged vertices lie near the middle of their
/// edge, so as far from there as the added vertex, on the other side.
inline Vec3i predicted_kept(Vec3i merged, Vec3i added) { return 2 * merged - added; }

/// A quotient of this many is followed by the value itself in 32 bits.
inline constexpr std::uint32_t kRiceEscape = 24;

/// Signed to unsigned: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
inline std::uint32_t zigzag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
}
inline std::int32_t unzigzag(std::uint32_t value) {
  return static_cast<std::int32_t>(value >> 1) ^ -static_cast<std::int32_t>(value & 1);
}

}  // namespace pmesh
