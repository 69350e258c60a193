// Bit strings, least significant bit first: bit i of the string is bit i % 8 of byte i / 8.
#pragma once

#include <cassert>
#include <cstdint>

#include "core/base/bytes.h"

namespace pmesh {

class BitWriter {
 public:
  /// Appends the low `count` bits of `value`. Precondition: count <= 32, value < 2^count.
  void put(std::uint32_t value, int count) {
    assert(count >= 0 && count <= 32 && (count == 32 || value >> count == 0));
    pending_ |= std::uint64_t{value} << pending_bits_;
    pending_bits_ += count;
    while (pending_bits_ >= 8) {
      bytes_.push_back(static_cast<std::uint8_t>(pending_));
      pending_ >>= 8;
      pending_bits_ -= 8;
    }
  }

  std::size_t bit_count() const {
    return 8 * bytes_.size() + static_cast<std::size_t>(pending_bits_);
  }

  /// The string, its last byte filled up with zero bits.
  Bytes finish() && {
    if (pending_bits_ > 0) bytes_.push_back(static_cast<std::uint8_t>(pending_));
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
  std::uint64_t pending_ = 0;
  int pending_bits_ = 0;
};

}  // namespace pmesh
