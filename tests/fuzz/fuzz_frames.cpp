// The TCP protocol's frames and messages. The first byte seeds the cuts of the rest: whole and in
// pieces must give the same frames, and every message that parses must be written back the same.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "protocol/messages.h"

namespace {

using namespace pmesh;

void require(bool condition) {
  if (!condition) std::abort();
}

struct Parsed {
  std::vector<Frame> frames;
  bool bad = false;

  friend bool operator==(const Parsed&, const Parsed&) = default;
};

void feed(FrameParser& parser, ByteView bytes, Parsed& parsed) {
  FrameStep step = parser.feed(bytes);
  for (; step == FrameStep::done; step = parser.feed(bytes)) {
    parsed.frames.push_back(parser.frame());
  }
  parsed.bad = step == FrameStep::bad;
}

Parsed parse_whole(ByteView bytes) {
  FrameParser parser;
  Parsed parsed;
  feed(parser, bytes, parsed);
  return parsed;
}

Parsed parse_in_pieces(ByteView bytes, std::uint32_t seed) {
  FrameParser parser;
  Parsed parsed;
  while (!bytes.empty() && !parsed.bad) {
    seed = seed * 1664525u + 1013904223u;
    const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + (seed >> 28));
    feed(parser, bytes.first(piece), parsed);
    bytes = bytes.subspan(piece);
  }
  return parsed;
}

/// Whether the message, if there is one, is encoded to the frame that it came from.
template <class Message, class Encode>
void check(const Frame& frame, const Result<Message>& message, Encode encode) {
  if (!message) return;
  const Bytes expected = encode_frame(frame.type, frame.stream, frame.payload);
  require(encode(*message) == expected);
}

void check_message(const Frame& frame) {
  const std::uint16_t stream = frame.stream;
  switch (frame.type) {
    case FrameType::hello:  // of a later version only the beginning is known
      if (const auto hello = parse_hello(frame.payload);
          hello && hello->version == kProtocolVersion && stream == kConnectionStream) {
        check(frame, hello, encode_hello);
      }
      break;
    case FrameType::open:
      check(frame, parse_open(frame.payload),
            [&](const Open& m) { return encode_open(stream, m); });
      break;
    case FrameType::opened:
      check(frame, parse_opened(frame.payload),
            [&](const Opened& m) { return encode_opened(stream, m); });
      break;
    case FrameType::want:  // "ratio=0.50" has a shorter spelling
      if (const auto want = parse_want(frame.payload)) {
        const Bytes again = encode_want(stream, *want);
        require(parse_want(ByteView(again).subspan(kFrameHeaderBytes)).value() == *want);
      }
      break;
    case FrameType::data:
      check(frame, parse_data(frame.payload),
            [&](const Data& m) { return encode_data(stream, m); });
      break;
    case FrameType::done:
      check(frame, parse_done(frame.payload),
            [&](const Done& m) { return encode_done(stream, m); });
      break;
    case FrameType::failure:
      check(frame, parse_failure(frame.payload),
            [&](const Failure& m) { return encode_failure(stream, m); });
      break;
    default:
      break;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const ByteView bytes(data + 1, size - 1);
  const Parsed whole = parse_whole(bytes);
  require(parse_in_pieces(bytes, data[0]) == whole);
  for (const Frame& frame : whole.frames) check_message(frame);
  return 0;
}
