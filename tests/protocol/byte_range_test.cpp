#include "protocol/byte_range.h"

#include <string>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

constexpr std::uint64_t kLength = 1000;
constexpr RangeChoice kWhole{RangeKind::whole, {0, kLength}};
constexpr RangeChoice kNone{RangeKind::unsatisfiable, {}};

RangeChoice part(std::uint64_t begin, std::uint64_t end) { return {RangeKind::part, {begin, end}}; }

TEST(ByteRange, TakesFirstAndLast) {
  EXPECT_EQ(choose_range("bytes=0-0", kLength), part(0, 1));
  EXPECT_EQ(choose_range("bytes=10-19", kLength), part(10, 20));
  EXPECT_EQ(choose_range("bytes=0-999", kLength), part(0, 1000));
}

TEST(ByteRange, CutsTheEndToTheBody) {
  EXPECT_EQ(choose_range("bytes=10-5000", kLength), part(10, 1000));
  EXPECT_EQ(choose_range("bytes=10-18446744073709551615", kLength), part(10, 1000));
}

TEST(ByteRange, TakesAnOpenEnd) {
  EXPECT_EQ(choose_range("bytes=0-", kLength), part(0, 1000));
  EXPECT_EQ(choose_range("bytes=999-", kLength), part(999, 1000));
}

TEST(ByteRange, TakesASuffix) {
  EXPECT_EQ(choose_range("bytes=-1", kLength), part(999, 1000));
  EXPECT_EQ(choose_range("bytes=-2000", kLength), part(0, 1000));
}

TEST(ByteRange, IsUnsatisfiableBeyondTheEnd) {
  EXPECT_EQ(choose_range("bytes=1000-", kLength), kNone);
  EXPECT_EQ(choose_range("bytes=1000-2000", kLength), kNone);
  EXPECT_EQ(choose_range("bytes=-0", kLength), kNone);
  EXPECT_EQ(choose_range("bytes=0-", 0), kNone);
  EXPECT_EQ(choose_range("bytes=-5", 0), kNone);
}

TEST(ByteRange, UnderstandsNumbersOfAnySize) {
  EXPECT_EQ(choose_range("bytes=99999999999999999999999-", kLength), kNone);
  EXPECT_EQ(choose_range("bytes=5-99999999999999999999999", kLength), part(5, 1000));
  EXPECT_EQ(choose_range("bytes=-99999999999999999999999", kLength), part(0, 1000));
  const std::uint64_t large = std::uint64_t{1} << 40;
  EXPECT_EQ(choose_range("bytes=1099511627775-", large), part(large - 1, large));
}

TEST(ByteRange, IgnoresWhatIsMalformed) {
  for (const char* header : {"", "bytes", "bytes=", "bytes=-", "bytes=5", "bytes=a-b", "bytes=5-4",
                             "bytes= 0-1", "bytes=0-1 ", "bytes=0 -1", "bytes=+1-2", "bytes=0x1-2",
                             "bytes=--1", "bytes=1--2", "0-1"}) {
    EXPECT_EQ(choose_range(header, kLength), kWhole) << header;
  }
}

TEST(ByteRange, IgnoresOtherUnitsAndSeveralRanges) {
  EXPECT_EQ(choose_range("items=0-1", kLength), kWhole);
  EXPECT_EQ(choose_range("bytes=0-1,4-5", kLength), kWhole);
  EXPECT_EQ(choose_range("bytes=0-1,", kLength), kWhole);
}

TEST(ByteRange, TakesTheUnitInAnyCase) {
  EXPECT_EQ(choose_range("Bytes=0-1", kLength), part(0, 2));
}

}  // namespace
}  // namespace pmesh
