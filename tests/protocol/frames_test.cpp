#include "protocol/frames.h"

#include <vector>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

/// Two frames, one after the other: "abc" on stream 7, then an empty ping.
Bytes two_frames() {
  Bytes bytes = encode_frame(FrameType::data, 7, as_bytes("abc"));
  const Bytes ping = encode_frame(FrameType::ping, 0, {});
  bytes.insert(bytes.end(), ping.begin(), ping.end());
  return bytes;
}

std::vector<Frame> parse_in_pieces(ByteView bytes, std::size_t piece) {
  FrameParser parser;
  std::vector<Frame> frames;
  while (!bytes.empty()) {
    ByteView cut = bytes.first(std::min(piece, bytes.size()));
    bytes = bytes.subspan(cut.size());
    while (parser.feed(cut) == FrameStep::done) frames.push_back(parser.frame());
  }
  EXPECT_FALSE(parser.inside_frame());
  return frames;
}

std::string error_of(Bytes bytes, std::uint32_t max_payload = kMaxFramePayload) {
  FrameParser parser(max_payload);
  ByteView view = bytes;
  return parser.feed(view) == FrameStep::bad ? parser.error() : "";
}

TEST(Frames, LayOutTheHeaderLittleEndian) {
  const Bytes expected = {3, 0, 0, 0, 5, 0, 0x34, 0x12, 'a', 'b', 'c'};
  EXPECT_EQ(encode_frame(FrameType::data, 0x1234, as_bytes("abc")), expected);
}

TEST(FrameParser, GivesTheSameFramesWhateverTheCuts) {
  const Bytes bytes = two_frames();
  const std::vector<Frame> expected = {{FrameType::data, 7, {'a', 'b', 'c'}},
                                       {FrameType::ping, 0, {}}};
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    EXPECT_EQ(parse_in_pieces(bytes, piece), expected) << piece;
  }
}

TEST(FrameParser, LeavesTheBytesAfterAFrame) {
  const Bytes bytes = two_frames();
  FrameParser parser;
  ByteView view = bytes;
  EXPECT_EQ(parser.feed(view), FrameStep::done);
  EXPECT_EQ(view.size(), kFrameHeaderBytes);
}

TEST(FrameParser, AsksForMoreInsideAFrame) {
  const Bytes bytes = two_frames();
  FrameParser parser;
  ByteView view = ByteView(bytes).first(10);
  EXPECT_EQ(parser.feed(view), FrameStep::more);
  EXPECT_TRUE(view.empty());
  EXPECT_TRUE(parser.inside_frame());
}

TEST(FrameParser, ShowsAFrameUnderWay) {
  const Bytes bytes = encode_frame(FrameType::data, 3, Bytes{1, 2, 3});
  FrameParser parser;
  ByteView header = ByteView(bytes).first(7);
  parser.feed(header);
  EXPECT_EQ(parser.unfinished(), nullptr);
  ByteView more = ByteView(bytes).subspan(7, 3);
  parser.feed(more);
  ASSERT_NE(parser.unfinished(), nullptr);
  EXPECT_EQ(*parser.unfinished(), (Frame{FrameType::data, 3, {1, 2}}));
  ByteView rest = ByteView(bytes).subspan(10);
  parser.feed(rest);
  EXPECT_EQ(parser.unfinished(), nullptr);
}

TEST(FrameParser, TakesTheLargestPayload) {
  const Bytes frame = encode_frame(FrameType::data, 1, Bytes(kMaxFramePayload));
  EXPECT_EQ(parse_in_pieces(frame, 65536).size(), 1u);
}

TEST(FrameParser, RejectsAPayloadOverTheLimit) {
  EXPECT_NE(error_of({1, 0, 0x10, 0, 5, 0, 0, 0}), "");
  EXPECT_NE(error_of({5, 0, 0, 0, 5, 0, 0, 0}, 4), "");
  EXPECT_EQ(error_of({4, 0, 0, 0, 5, 0, 0, 0}, 4), "");
}

TEST(FrameParser, RejectsFlags) { EXPECT_NE(error_of({0, 0, 0, 0, 5, 1, 0, 0}), ""); }

TEST(FrameParser, StaysBad) {
  FrameParser parser;
  const Bytes bad = {0, 0, 0, 0, 5, 1, 0, 0}, good = two_frames();
  ByteView view = bad;
  EXPECT_EQ(parser.feed(view), FrameStep::bad);
  view = good;
  EXPECT_EQ(parser.feed(view), FrameStep::bad);
}

TEST(FrameParser, LeavesUnknownTypesToItsCaller) {
  const Bytes frame = encode_frame(static_cast<FrameType>(200), 0, {});
  FrameParser parser;
  ByteView view = frame;
  ASSERT_EQ(parser.feed(view), FrameStep::done);
  EXPECT_EQ(static_cast<int>(parser.frame().type), 200);
}

}  // namespace
}  // namespace pmesh
