// Codes positions as residuals to predictions; one template for both ways, as split_coder.h.
// docs/pm-format.md, section "Residuals", specifies what it does.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/result.h"
#include "core/pm/fixed_point.h"
#include "core/pm/patch.h"
#include "core/pm/split_model.h"

namespace pmesh {

template <class Coder>
class PointCoder {
 public:
  /// Of points with coordinates of that many bits.
  PointCoder(Coder& coder, int bits) : coder_(coder), bits_(bits) {}

  /// Two coordinates, then the one along which the normal is longest: what is known of the first
  /// ones shifts the next one along the tangential plane, so that the last residual is the normal
  /// part alone. Fails (bad_input) if one is off the lattice.
  Status code(const Patch& patch, const Prediction& prediction, SplitModel::Residuals& models,
              Vec3i& point) {
    const std::array<std::int64_t, 3> normal = {patch.normal.x, patch.normal.y, patch.normal.z};
    const std::size_t c = longest(normal), a = (c + 1) % 3, b = (c + 2) % 3;
    const std::array<std::int64_t, 3> at = {prediction.at.x, prediction.at.y, prediction.at.z};
    const std::array<std::int32_t*, 3> axes = {&point.x, &point.y, &point.z};
    const std::array<std::int32_t, 3> kept = {patch.kept.x, patch.kept.y, patch.kept.z};

    const auto code = [&](std::size_t axis, std::int64_t expected, std::size_t part, int likely) {
      return code_coordinate(kept[axis] + ((expected * (std::int64_t{1} << patch.shift) + 4) >> 3),
                             models, part, likely, *axes[axis]);
    };
    const auto off = [&](std::size_t axis, std::int64_t expected) {
      const std::int64_t local = (8 * (std::int64_t{*axes[axis]} - kept[axis])) >> patch.shift;
      return clamp_to(local - expected, std::int64_t{1} << 20);
    };
    bool on = code(a, at[a], 0, prediction.tangential_class);
    const std::int64_t off_a = off(a, at[a]);
    const std::int64_t across = patch.normal_squared - normal[a] * normal[a];
    const std::int64_t expected_b = at[b] + divide(-normal[a] * normal[b] * off_a, across);
    on = on && code(b, expected_b, 0, prediction.tangential_class);
    const std::int64_t slope = -(normal[a] * off_a + normal[b] * off(b, at[b]));
    const std::int64_t expected_c =
        at[c] + (normal[c] > 0 ? divide(slope, normal[c]) : divide(-slope, -normal[c]));
    on = on && code(c, expected_c, 1, prediction.normal_class);
    return on ? Status() : bad_input("off the lattice");
  }

  /// Sign and low bits of a number of the given bit length.
  std::int64_t code_tail(int length, std::int64_t value) {
    if (length == 0) return 0;
    const std::int64_t size = value < 0 ? -value : value;
    const auto top = std::uint32_t{1} << (length - 1);
    const std::uint32_t tail = coder_.raw(length, (static_cast<std::uint32_t>(size) - top) << 1 |
                                                      static_cast<std::uint32_t>(value < 0));
    const std::int64_t decoded = std::int64_t{top} + (tail >> 1);
    return (tail & 1) != 0 ? -decoded : decoded;
  }

 private:
  static std::size_t longest(const std::array<std::int64_t, 3>& v) {
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (std::abs(v[i]) > std::abs(v[axis])) axis = i;
    }
    return axis;
  }

  // False if the coordinate is off the lattice.
  bool code_coordinate(std::int64_t expected, SplitModel::Residuals& models, std::size_t part,
                       int likely, std::int32_t& coordinate) {
    const std::int64_t most = (std::int64_t{1} << bits_) - 1;
    expected = expected < 0 ? 0 : expected > most ? most : expected;
    const std::int64_t wanted = std::int64_t{coordinate} - expected;
    const int centre = std::max(0, likely / 2 - (part == 0 ? 5 : 4));
    const int length = code_length(models.length[part][static_cast<std::size_t>(likely)], centre,
                                   bit_length(wanted));
    const std::int64_t coded = expected + code_residual(length, models.second[part], wanted);
    if (coded < 0 || coded > most) return false;
    coordinate = static_cast<std::int32_t>(coded);
    return true;
  }

  int code_length(LengthModel& model, int centre, int wanted) {
    const auto step = [](int distance) { return static_cast<std::size_t>(std::min(distance, 7)); };
    int length = centre;
    if (coder_.bit(model.above, wanted > centre)) {
      ++length;
      while (length < 31 && coder_.bit(model.up[step(length - centre - 1)], wanted > length)) {
        ++length;
      }
    } else {
      while (length > 0 && coder_.bit(model.down[step(centre - length)], wanted < length)) {
        --length;
      }
    }
    return length;
  }

  std::int64_t code_residual(int length, std::array<AdaptiveBit, 32>& second, std::int64_t wanted) {
    if (length < 2) return code_tail(length, wanted);
    const std::int64_t size = wanted < 0 ? -wanted : wanted;
    const bool high =
        coder_.bit(second[static_cast<std::size_t>(length)], (size >> (length - 2) & 1) != 0);
    const std::uint32_t below = std::uint32_t{1} << (length - 2);
    const std::uint32_t tail =
        coder_.raw(length - 1, (static_cast<std::uint32_t>(size) & (below - 1)) << 1 |
                                   static_cast<std::uint32_t>(wanted < 0));
    const std::int64_t coded = std::int64_t{high ? 3 : 2} * below + (tail >> 1);
    return (tail & 1) != 0 ? -coded : coded;
  }

  Coder& coder_;
  int bits_;
};

}  // namespace pmesh
