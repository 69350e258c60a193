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

  explicit ChunkReader(ByteView bytes) : bytes_(bytes), back_(bytes.size()) {
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
      if (front_ <= back_ + kAhead && back_ > 0) {
        raw_ |= std::uint64_t{bytes_[--back_]} << raw_bits_;
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

  /// Whether the two streams meet, but for bytes that the range coder only looked ahead at, or
  /// nothing but zero filling is left between them.
  bool at_end() const {
    for (std::size_t i = front_; i < back_; ++i) {
      if (bytes_[i] != 0) return false;
    }
    return front_ < back_ + kAhead && raw_ == 0;
  }

 private:
  std::uint32_t next_unit() {
    if (front_ >= back_ + kAhead) failed_ = true;
    const std::uint32_t unit = next_byte() << 8;
    return unit | next_byte();
  }

  // Behind the chunk's last byte are zeros.
  std::uint32_t next_byte() {
    const std::size_t at = front_++;
    return at < bytes_.size() ? bytes_[at] : 0;
  }

  /// The range coder reads this far ahead of the bytes that it needs.
  static constexpr std::size_t kAhead = 6;

  ByteView bytes_;
  std::size_t front_ = 0, back_;  // read from the front, and left by the back
  std::uint64_t range_ = (std::uint64_t{1} << 48) - 1;
  std::uint64_t code_ = 0;
  std::uint64_t raw_ = 0;
  int raw_bits_ = 0;
  bool failed_ = false;
};

}  // namespace pmesh
