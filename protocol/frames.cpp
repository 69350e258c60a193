#include "protocol/frames.h"

#include <algorithm>
#include <cassert>

namespace pmesh {

std::array<std::uint8_t, kFrameHeaderBytes> frame_header(FrameType type, std::uint16_t stream,
                                                         std::size_t payload_bytes) {
  assert(payload_bytes <= kMaxFramePayload);
  const auto length = static_cast<std::uint32_t>(payload_bytes);
  const auto byte = [](std::uint32_t value, int index) {
    return static_cast<std::uint8_t>(value >> (8 * index));
  };
  return {byte(length, 0),
          byte(length, 1),
          byte(length, 2),
          byte(length, 3),
          static_cast<std::uint8_t>(type),
          0,
          byte(stream, 0),
          byte(stream, 1)};
}

Bytes encode_frame(FrameType type, std::uint16_t stream, ByteView payload) {
  const auto header = frame_header(type, stream, payload.size());
  Bytes frame(header.size() + payload.size());
  std::copy(payload.begin(), payload.end(), std::copy(header.begin(), header.end(), frame.begin()));
  return frame;
}

FrameParser::FrameParser(std::uint32_t max_payload) : max_payload_(max_payload) {
  assert(max_payload <= kMaxFramePayload);
}

FrameStep FrameParser::feed(ByteView& bytes) {
  if (!error_.empty()) return FrameStep::bad;
  if (!take_header(bytes)) return FrameStep::more;
  if (!error_.empty()) return FrameStep::bad;

  const std::size_t taken = std::min(bytes.size(), payload_bytes_ - frame_.payload.size());
  frame_.payload.insert(frame_.payload.end(), bytes.begin(), bytes.begin() + taken);
  bytes = bytes.subspan(taken);
  if (frame_.payload.size() < payload_bytes_) return FrameStep::more;
  header_bytes_ = 0;
  return FrameStep::done;
}

/// True once the header is whole.
bool FrameParser::take_header(ByteView& bytes) {
  if (header_bytes_ == kFrameHeaderBytes) return true;
  const std::size_t taken = std::min(bytes.size(), kFrameHeaderBytes - header_bytes_);
  std::copy_n(bytes.begin(), taken, header_.begin() + header_bytes_);
  bytes = bytes.subspan(taken);
  header_bytes_ += taken;
  if (header_bytes_ < kFrameHeaderBytes) return false;
  check_header();
  return true;
}

void FrameParser::check_header() {
  ByteReader reader(header_);
  payload_bytes_ = reader.get<std::uint32_t>();
  frame_.type = static_cast<FrameType>(reader.get<std::uint8_t>());
  const auto flags = reader.get<std::uint8_t>();
  frame_.stream = reader.get<std::uint16_t>();
  frame_.payload.clear();
  if (payload_bytes_ > max_payload_) {
    error_ = "frame of " + std::to_string(payload_bytes_) + " bytes exceeds the limit of " +
             std::to_string(max_payload_);
  } else if (flags != 0) {
    error_ = "frame flags are " + std::to_string(flags) + ", expected 0";
  }
}

}  // namespace pmesh
