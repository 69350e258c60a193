#include "core/pm/digest.h"

#include <gtest/gtest.h>

#include "core/base/crc32c.h"

namespace pmesh {
namespace {

TEST(Crc32c, MatchesTheStandardsCheckValue) {
  EXPECT_EQ(crc32c(as_bytes("123456789")), 0xE3069283u);
  EXPECT_EQ(crc32c({}), 0u);
}

TEST(Crc32c, ContinuesFromAnEarlierResult) {
  const ByteView text = as_bytes("The quick brown fox jumps over the lazy dog");
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    EXPECT_EQ(crc32c(text.subspan(cut), crc32c(text.first(cut))), crc32c(text));
  }
}

TEST(Digest, IsTheStartOfSha256) {
  const SectionDigest abc = {0xba, 0x78, 0x16, 0xbf, 0x8f, 0x01, 0xcf, 0xea};  // FIPS 180-4
  EXPECT_EQ(digest_section(as_bytes("abc")), abc);
}

TEST(Digest, ThePrologueHashDoesNotDependOnItsOwnField) {
  Bytes prologue(100, 1);
  const ContentHash hash = hash_prologue(prologue);
  std::copy(hash.begin(), hash.end(), prologue.begin() + kContentHashOffset);
  EXPECT_EQ(hash_prologue(prologue), hash);
  prologue.back() = 2;
  EXPECT_NE(hash_prologue(prologue), hash);
}

}  // namespace
}  // namespace pmesh
