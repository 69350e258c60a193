#include "core/measure/spatial_order.h"

#include <algorithm>
#include <array>

#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

constexpr int kBits = 16;  // an axis

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

std::uint32_t cell(double coordinate) {
  constexpr double kCells = 1 << kBits;
  return static_cast<std::uint32_t>(std::clamp((coordinate + 1) * (kCells / 2), 0.0, kCells - 1));
}

// Bit i of `value` to bit 3 i.
std::uint64_t spread(std::uint64_t value) {
  value = (value | value << 16) & 0x0000'FF00'00FF;
  value = (value | value << 8) & 0x00F0'0F00'F00F;
  value = (value | value << 4) & 0x0C30'C30C'30C3;
  return (value | value << 2) & 0x2492'4924'9249;
}

// The Hilbert index of a cell: J. Skilling, Programming the Hilbert curve (2004), which turns the
// coordinates in place, plane by plane, until their interleaved bits are the index.
std::uint64_t hilbert_key(Vec3d point) {
  std::array<std::uint32_t, 3> x = {cell(point.x), cell(point.y), cell(point.z)};
  for (std::uint32_t bit = 1u << (kBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::uint32_t& axis : x) {
      const std::uint32_t is_set = axis & bit ? ~0u : 0u;
      const std::uint32_t swapped = (x[0] ^ axis) & below & ~is_set;
      x[0] ^= (below & is_set) | swapped;
      axis ^= swapped;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flips = 0;
  for (std::uint32_t bit = 1u << (kBits - 1); bit > 1; bit >>= 1) {
    if (x[2] & bit) flips ^= bit - 1;
  }
  return spread(x[0] ^ flips) << 2 | spread(x[1] ^ flips) << 1 | spread(x[2] ^ flips);
}

// One stable pass of a radix sort, by the digit of `key` at `shift`.
void sort_pass(const std::vector<Keyed>& from, std::vector<Keyed>& to, int shift) {
  constexpr std::size_t kDigits = 1 << 12;
  std::array<std::uint32_t, kDigits + 1> begin{};
  const auto digit = [&](const Keyed& k) { return (k.key >> shift) & (kDigits - 1); };
  for (const Keyed& k : from) ++begin[digit(k) + 1];
  for (std::size_t d = 0; d < kDigits; ++d) begin[d + 1] += begin[d];
  for (const Keyed& k : from) to[begin[digit(k)]++] = k;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(std::span<const Vec3d> points, unsigned threads) {
  const auto count = static_cast<std::uint32_t>(points.size());
  std::vector<Keyed> keyed(count), sorted(count);
  for_blocks(count, threads, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) keyed[i] = {hilbert_key(points[i]), i};
  });
  for (int shift = 0; shift < 3 * kBits; shift += 12) {
    sort_pass(keyed, sorted, shift);
    std::swap(keyed, sorted);
  }
  std::vector<std::uint32_t> order(count);
  std::transform(keyed.begin(), keyed.end(), order.begin(), [](const Keyed& k) { return k.index; });
  return order;
}

}  // namespace pmesh
