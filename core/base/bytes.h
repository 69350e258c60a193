// Little-endian readers and writers. Every multi-byte number of the PM file and of the TCP frames
// goes through these; structs are never cast to bytes.
#pragma once

#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace pmesh {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

inline ByteView as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Appends numbers to a byte vector.
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& out) : out_(out) {}

  template <std::unsigned_integral T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      out_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
  }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(ByteView bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }

 private:
  Bytes& out_;
};

/// Reads numbers from a byte span. Reading past the end gives zero and sets `failed()`, which is
/// checked once after a group of reads.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  T get() {
    if (remaining() < sizeof(T)) {
      failed_ = true;
      position_ = bytes_.size();
      return 0;
    }
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value |= std::uint64_t{bytes_[position_++]} << (8 * i);
    }
    return static_cast<T>(value);
  }
  double get_double() { return std::bit_cast<double>(get<std::uint64_t>()); }

  /// The next `count` bytes; empty, and failed, if there are fewer.
  ByteView take(std::size_t count) {
    if (remaining() < count) {
      failed_ = true;
      position_ = bytes_.size();
      return {};
    }
    const ByteView taken = bytes_.subspan(position_, count);
    position_ += count;
    return taken;
  }

  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  bool failed() const { return failed_; }

 private:
  ByteView bytes_;
  std::size_t position_ = 0;
  bool failed_ = false;
};

}  // namespace pmesh
