#include "core/pm/verify.h"

#include <functional>

#include <gtest/gtest.h>

#include "core/base/crc32c.h"
#include "core/pm/digest.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

class Verify : public ::testing::Test {
 protected:
  std::string error_of(const Bytes& file) {
    const std::string path = directory_.write("x.pmesh", file);
    const auto verified = verify_file(path);
    if (verified) return "none";
    EXPECT_EQ(verified.error().code, ErrorCode::verification);
    return verified.error().message.substr(path.size() + 2);
  }

  // The shape's file with a lie in its prologue, hashed and checksummed as a forger would.
  Bytes forged(const std::function<void(FileIndex&)>& lie) {
    FileIndex index = **parse_prologue(shape_.file);
    const std::uint32_t body = index.prologue_bytes;
    lie(index);
    const Bytes unhashed = write_prologue(index);
    index.header.content_hash = hash_prologue(unhashed);
    Bytes file = write_prologue(index);
    file.insert(file.end(), shape_.file.begin() + body, shape_.file.end());
    return file;
  }

  TemporaryDirectory directory_;
  EncodedShape shape_ = encode_shape("ball", shapes::icosphere(4));
};

TEST_F(Verify, AcceptsWhatTheEncoderWrites) {
  const auto verified = verify_file(directory_.write("x.pmesh", shape_.file));
  ASSERT_TRUE(verified.ok()) << verified.error().message;
  EXPECT_TRUE(same_triangles(verified->full, shape_.quantised));
}

TEST_F(Verify, AcceptsRelocations) {
  shape_ = encode_relocating_shape("ball", shapes::icosphere(4));
  const auto verified = verify_file(directory_.write("x.pmesh", shape_.file));
  ASSERT_TRUE(verified.ok()) << verified.error().message;
  EXPECT_TRUE(same_triangles(verified->full, shape_.quantised));
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.header.box_low.x -= 1; })), "wrong bounding box");
}

TEST_F(Verify, NamesTheMissingBytesOfAPartialFile) {
  const Bytes part(shape_.file.begin(), shape_.file.end() - 10);
  EXPECT_EQ(error_of(part), "incomplete: 10 bytes are missing");
}

TEST_F(Verify, NamesTheDamagedChunk) {
  Bytes file = shape_.file;
  file.back() ^= 0x10;
  const std::size_t last = (**parse_prologue(file)).chunks.size() - 1;
  EXPECT_EQ(error_of(file), "chunk " + std::to_string(last) + ": wrong checksum");
}

TEST_F(Verify, SeesThroughForgedClaims) {
  EXPECT_EQ(error_of(forged([](FileIndex&) {})), "none");
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.chunks[0].digest[0] ^= 1; })),
            "chunk 0: wrong digest");
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.header.base_digest[0] ^= 1; })),
            "base mesh: wrong digest");
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.header.box_low.x += 1; })), "wrong bounding box");
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.header.base_bytes = 0; })),
            "header: the base's bytes do not fit its faces");
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.header.has_borders = true; })).substr(0, 8),
            "chunk 0:");
  EXPECT_EQ(error_of(forged([](FileIndex& i) { i.header.has_relocations = true; })).substr(0, 8),
            "chunk 0:");
  EXPECT_EQ(error_of(forged([](FileIndex& i) {
              i.chunks[0].vertices += 1, i.chunks[0].faces += 2;
            })).substr(0, 8),
            "chunk 0:");
}

}  // namespace
}  // namespace pmesh
