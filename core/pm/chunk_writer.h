// Writes the two bit streams of a chunk's splits; the inverse of ChunkReader.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/base/bits.h"
#include "core/base/bytes.h"
#include "core/pm/adaptive_bit.h"
#include "core/pm/split_section.h"

namespace pmesh {

class ChunkWriter {
 public:
  static constexpr bool kDecodes = false;

  bool bit(AdaptiveBit& model, bool one) {
    const std::uint64_t bound = (range_ >> 16) * model.one();
    if (one) {
      range_ = bound;
    } else {
      range_ -= bound;
      low_ += bound;
    }
    model.update(one);
    if (range_ < std::uint64_t{1} << 32) {
      range_ <<= 16;
      put_unit();
    }
    return one;
  }

  /// Precondition: count <= 32, value < 2^count.
  std::uint32_t raw(int count, std::uint32_t value) {
    raw_.put(value, count);
    return value;
  }

  void enter(SplitSection /*section*/) {}

  /// At most what finish() would make.
  std::size_t byte_count() const { return front_.size() + 3 + (raw_.bit_count() + 7) / 8; }

  /// The chunk, filled up with zeros to at least `least` bytes.
  Bytes finish(std::size_t least = 0) &&;

 private:
  // Moves the top 16 bits of low_ out; a carry runs into the units written before.
  void put_unit() {
    if (low_ >> 48 != 0) {
      std::size_t i = front_.size();
      while (++front_[--i] == 0) {
      }
    }
    front_.push_back(static_cast<std::uint8_t>(low_ >> 40));
    front_.push_back(static_cast<std::uint8_t>(low_ >> 32));
    low_ = (low_ & 0xFFFF'FFFF) << 16;
  }

  Bytes front_;
  BitWriter raw_;
  std::uint64_t range_ = (std::uint64_t{1} << 48) - 1;
  std::uint64_t low_ = 0;
};

}  // namespace pmesh
