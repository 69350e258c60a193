// The HTTP Range header (RFC 9110, section 14): one range of bytes of a body.
//
// Threads: pure functions.
#pragma once

#include <cstdint>
#include <string_view>

namespace pmesh {

/// Bytes [begin, end) of a body or of a file.
struct ByteSpan {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;

  std::uint64_t size() const { return end - begin; }
  friend bool operator==(const ByteSpan&, const ByteSpan&) = default;
};

enum class RangeKind : std::uint8_t {
  whole,          ///< No range, or one to ignore: answer 200 with the whole body.
  part,           ///< Answer 206 with `span`.
  unsatisfiable,  ///< Answer 416.
};

struct RangeChoice {
  RangeKind kind = RangeKind::whole;
  ByteSpan span;  ///< What to send; empty if unsatisfiable.

  friend bool operator==(const RangeChoice&, const RangeChoice&) = default;
};

/// What the value of a Range header asks of a body of `length` bytes. "bytes=a-b", "bytes=a-" and
/// "bytes=-n" are understood, with numbers of any size; an end beyond the body is cut to it. An
/// empty or malformed value, another unit, and more than one range give the whole body.
RangeChoice choose_range(std::string_view header, std::uint64_t length);

}  // namespace pmesh
