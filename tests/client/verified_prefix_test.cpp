#include "client/verified_prefix.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/client/sample.h"

namespace pmesh {
namespace {

using test::sample_file;
using test::sample_index;

Bytes altered(std::uint64_t offset) {
  Bytes file = sample_file();
  file[static_cast<std::size_t>(offset)] ^= 0x10;
  return file;
}

TEST(VerifiedPrefix, HoldsTheWholeFile) {
  VerifiedPrefix prefix;
  ASSERT_TRUE(prefix.append(sample_file()).ok());
  EXPECT_EQ(prefix.verified().size(), sample_file().size());
  EXPECT_EQ(prefix.chunk_count(), sample_index().chunks.size());
}

TEST(VerifiedPrefix, IsTheSameWhateverTheCuts) {
  for (const std::size_t cut : {1, 7, 1000, 16'384}) {
    VerifiedPrefix prefix;
    for (std::size_t at = 0; at < sample_file().size(); at += cut) {
      const std::size_t count = std::min(cut, sample_file().size() - at);
      ASSERT_TRUE(prefix.append(ByteView(sample_file()).subspan(at, count)).ok());
    }
    EXPECT_TRUE(std::ranges::equal(prefix.verified(), sample_file()));
  }
}

TEST(VerifiedPrefix, VerifiesWholeSectionsOnly) {
  VerifiedPrefix prefix;
  const std::uint64_t end = sample_index().chunks[1].end();
  ASSERT_TRUE(prefix.append(ByteView(sample_file()).first(end + 1)).ok());
  EXPECT_EQ(prefix.verified().size(), end);
  EXPECT_EQ(prefix.size(), end + 1);
  EXPECT_EQ(prefix.chunk_count(), 2u);
}

TEST(VerifiedPrefix, HasNoBaseBeforeItsLastByte) {
  VerifiedPrefix prefix;
  const std::uint64_t base_end = sample_index().base_end();
  ASSERT_TRUE(prefix.append(ByteView(sample_file()).first(base_end - 1)).ok());
  EXPECT_FALSE(prefix.has_base());
  ASSERT_TRUE(prefix.append(ByteView(sample_file()).subspan(base_end - 1, 1)).ok());
  EXPECT_TRUE(prefix.has_base());
}

TEST(VerifiedPrefix, NamesAnAlteredChunk) {
  VerifiedPrefix prefix;
  const Status status = prefix.append(altered(sample_index().chunks[2].offset + 5));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::verification);
  EXPECT_NE(status.error().message.find("chunk 2"), std::string::npos);
  EXPECT_EQ(prefix.size(), sample_index().chunks[1].end());
}

TEST(VerifiedPrefix, NoticesAnAlteredBase) {
  VerifiedPrefix prefix;
  const Status status = prefix.append(altered(sample_index().prologue_bytes + 3));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::verification);
}

TEST(VerifiedPrefix, RefusesAnAlteredHeaderOrIndex) {
  for (const std::uint64_t offset :
       {kContentHashOffset, kContentHashOffset + 20, sample_index().prologue_bytes - 1ul}) {
    VerifiedPrefix prefix;
    const Status status = prefix.append(altered(offset));
    ASSERT_FALSE(status.ok()) << offset;
    EXPECT_EQ(status.error().code, ErrorCode::verification) << offset;
  }
}

TEST(VerifiedPrefix, RefusesOtherFiles) {
  VerifiedPrefix prefix;
  const Status status = prefix.append(as_bytes("<html>This is no PM file at all</html>"));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::bad_input);
}

TEST(VerifiedPrefix, RefusesBytesAfterTheEnd) {
  VerifiedPrefix prefix;
  ASSERT_TRUE(prefix.append(sample_file()).ok());
  EXPECT_FALSE(prefix.append(as_bytes("x")).ok());
  EXPECT_EQ(prefix.size(), sample_file().size());
}

}  // namespace
}  // namespace pmesh
