// The frames of the TCP protocol (docs/protocol.md, section 3): a header of eight bytes, then the
// payload. All numbers are little-endian.
//
//   0               4      5       6        8
//   +---------------+------+-------+--------+--- ... ---+
//   | payload bytes | type | flags | stream |  payload  |
//   +---------------+------+-------+--------+--- ... ---+
//
// Threads: a parser belongs to one thread at a time; the functions are pure.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/bytes.h"

namespace pmesh {

inline constexpr std::size_t kFrameHeaderBytes = 8;
inline constexpr std::uint32_t kMaxFramePayload = 1024 * 1024;

/// Stream 0 is the connection itself (hello, ping, pong, fatal failures); meshes are streamed on
/// the others.
inline constexpr std::uint16_t kConnectionStream = 0;

enum class FrameType : std::uint8_t {
  hello = 1,
  open = 2,
  opened = 3,
  want = 4,
  data = 5,
  done = 6,
  pause = 7,
  resume = 8,
  cancel = 9,
  ping = 10,
  pong = 11,
  failure = 12,
  authorise = 13,
};

/// The type may be none of the enumerators: what to do with such a frame is its receiver's choice.
struct Frame {
  FrameType type{};
  std::uint16_t stream = kConnectionStream;
  Bytes payload;

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// The header of a frame whose payload is sent apart. Precondition: at most kMaxFramePayload.
std::array<std::uint8_t, kFrameHeaderBytes> frame_header(FrameType type, std::uint16_t stream,
                                                         std::size_t payload_bytes);

/// The whole frame. Precondition: a payload of at most kMaxFramePayload.
Bytes encode_frame(FrameType type, std::uint16_t stream, ByteView payload);

enum class FrameStep : std::uint8_t {
  more,  ///< All bytes are taken and no frame is whole yet.
  done,  ///< frame() is whole; the bytes after it are left.
  bad,   ///< error() says why; the connection cannot go on.
};

/// Takes a connection's bytes in any cuts and gives its frames one by one.
class FrameParser {
 public:
  /// A frame with a larger payload than `max_payload` is bad. Memory: at most max_payload, and
  /// never more than twice the bytes fed.
  explicit FrameParser(std::uint32_t max_payload = kMaxFramePayload);

  /// Takes bytes from the front of `bytes` (which is moved on) up to the end of the next frame.
  /// Once bad, always bad.
  FrameStep feed(ByteView& bytes);

  /// The frame that the last feed() completed; until the next feed(). May be moved from.
  Frame& frame() { return frame_; }
  /// What is wrong. Precondition: feed() answered bad.
  const std::string& error() const { return error_; }

  /// The frame under way, with what has come of its payload; null before its header is whole, and
  /// once bad.
  const Frame* unfinished() const {
    return header_bytes_ == kFrameHeaderBytes && error_.empty() ? &frame_ : nullptr;
  }

  /// True if the bytes so far end inside a frame: a connection closed here was cut.
  bool inside_frame() const { return header_bytes_ > 0; }

 private:
  bool take_header(ByteView& bytes);
  void check_header();

  std::uint32_t max_payload_;
  std::array<std::uint8_t, kFrameHeaderBytes> header_{};
  std::size_t header_bytes_ = 0;
  std::size_t payload_bytes_ = 0;
  Frame frame_;
  std::string error_;
};

}  // namespace pmesh
