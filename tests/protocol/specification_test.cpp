// The worked examples of docs/protocol.md: blocks of hex digits fenced as "```frame NAME".
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "protocol/messages.h"

namespace pmesh {
namespace {

/// The bytes of hex pairs, up to what is not one: the rest of a line is its comment.
Bytes parse_hex_line(const std::string& line) {
  std::istringstream words(line);
  Bytes bytes;
  for (std::string word; words >> word && word.size() == 2;) {
    if (word.find_first_not_of("0123456789abcdef") != std::string::npos) break;
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

std::map<std::string, Bytes> example_frames() {
  const std::string fence = "```frame ";
  std::ifstream specification(PMESH_PROTOCOL_SPECIFICATION);
  std::map<std::string, Bytes> frames;
  std::string name;
  for (std::string line; std::getline(specification, line);) {
    if (line.starts_with(fence)) {
      name = line.substr(fence.size());
    } else if (line.starts_with("```")) {
      name.clear();
    } else if (!name.empty()) {
      const Bytes bytes = parse_hex_line(line);
      frames[name].insert(frames[name].end(), bytes.begin(), bytes.end());
    }
  }
  return frames;
}

TEST(Specification, ExampleFramesAreWhatTheCodeWrites) {
  const ContentHash hash = {0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77,
                            0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};
  const Opened opened{hash, 1'000'000, 34'834, 69'451, 102, 200, 40};
  const Want want{.from_offset = 0, .wish = {.kind = WishKind::faces, .count = 1000}};
  const std::map<std::string, Bytes> expected = {
      {"hello", encode_hello({.version = 0, .max_frame = 65536})},
      {"open", encode_open(1, {.id = "bunny", .hash = {}})},
      {"opened", encode_opened(1, opened)},
      {"want", encode_want(1, want)},
      {"data", encode_data(1, {0, ByteView(kMagic)})},
      {"done", encode_done(1, {.end = 16384, .faces = 1000, .vertices = 502, .reached = true})},
      {"pause", encode_empty(FrameType::pause, 1)},
      {"authorise", encode_authorise("token")},
      {"failure", encode_failure(1, {FailureCode::not_found, "no such mesh"})},
  };
  EXPECT_EQ(example_frames(), expected);
}

}  // namespace
}  // namespace pmesh
