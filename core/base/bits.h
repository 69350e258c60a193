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

/// Reading past the end gives zero bits and sets failed().
class BitReader {
 public:
  explicit BitReader(ByteView bytes) : bytes_(bytes) {}

  /// The next `count` bits. Precondition: count <= 32.
  std::uint32_t get(int count) {
    assert(count >= 0 && count <= 32);
    while (available_ < count) {
      if (position_ < bytes_.size()) {
        pending_ |= std::uint64_t{bytes_[position_++]} << available_;
      } else {
        failed_ = true;
      }
      available_ += 8;
    }
    const auto value = static_cast<std::uint32_t>(pending_ & ((std::uint64_t{1} << count) - 1));
    pending_ >>= count;
    available_ -= count;
    return value;
  }

  bool failed() const { return failed_; }
  /// Whether nothing but the last byte's zero filling is left.
  bool at_end() const { return position_ == bytes_.size() && available_ < 8 && pending_ == 0; }

 private:
  ByteView bytes_;
  std::size_t position_ = 0;
  std::uint64_t pending_ = 0;
  int available_ = 0;
  bool failed_ = false;
};

}  // namespace pmesh
