// Reads the two bit streams of a chunk's splits: adaptive decisions, range-coded in 16-bit units
// from the front, and raw bits from the back (docs/pm-format.md, "The two streams"). The range
// coder is G. N. N. Martin's (Range encoding: an algorithm for removing redundancy from a digitised
// message, Video and Data Recording Conference, 1979), with 48 bits of range.
#pragma once

#include <cassert>
#include <cstdint>

#include "core/base/bytes.h"
#include "core/pm/adaptive_bit.h"
#include "core/pm/split_section.h"

namespace pmesh {

/// Reading past the end gives zeros and sets failed(). Has the face of ChunkWriter, so that one
/// template codes both ways; the values handed in are ignored.
class ChunkReader {
 public:
  static constexpr bool kDecodes = true;

  explicit ChunkReader(ByteView bytes) : front_(bytes.data()), back_(bytes.data() + bytes.size()) {
    for (int unit = 0; unit < 3; ++unit) code_ = code_ << 16 | next_unit();
    if (code_ >= range_) failed_ = true;  // no writer's; it would stay so, and overflow
  }

  bool bit(AdaptiveBit& model, bool /*ignored*/ = false) {
    const std::uint64_t bound = (range_ >> 16) * model.one();
    const bool one = code_ < bound;
    if (one) {
      range_ = bound;
    } else {
      range_ -= bound;
      code_ -= bound;
    }
    model.update(one);
    if (range_ < std::uint64_t{1} << 32) {
      range_ <<= 16;
      code_ = code_ << 16 | next_unit();
    }
    return one;
  }

  /// The next `count` raw bits. Precondition: count <= 32.
  std::uint32_t raw(int count, std::uint32_t /*ignored*/ = 0) {
    assert(count >= 0 && count <= 32);
    while (raw_bits_ < count) {
      if (front_ < back_) {
        raw_ |= std::uint64_t{*--back_} << raw_bits_;
      } else {
        failed_ = true;
      }
      raw_bits_ += 8;
    }
    const auto value = static_cast<std::uint32_t>(raw_ & ((std::uint64_t{1} << count) - 1));
    raw_ >>= count;
    raw_bits_ -= count;
    return value;
  }

  /// What is coded next; only meters look at it.
  void enter(SplitSection /*section*/) {}

  bool failed() const { return failed_; }

  /// Whether nothing but zero filling is left between the two streams.
  bool at_end() const {
    for (const std::uint8_t* p = front_; p < back_; ++p) {
      if (*p != 0) return false;
    }
    return raw_ == 0;
  }

 private:
  std::uint32_t next_unit() {
    if (back_ - front_ < 2) {
      failed_ = true;
      return 0;
    }
    const std::uint32_t unit = std::uint32_t{front_[0]} << 8 | front_[1];
    front_ += 2;
    return unit;
  }

  const std::uint8_t* front_;
  const std::uint8_t* back_;
  std::uint64_t range_ = (std::uint64_t{1} << 48) - 1;
  std::uint64_t code_ = 0;
  std::uint64_t raw_ = 0;
  int raw_bits_ = 0;
  bool failed_ = false;
};

}  // namespace pmesh
