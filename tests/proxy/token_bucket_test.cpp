#include "tests/proxy/token_bucket.h"

#include <gtest/gtest.h>

namespace pmesh::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr TokenBucket::Clock::time_point kStart{std::chrono::hours(1)};

TEST(TokenBucket, LetsBytesPassAtItsRate) {
  TokenBucket bucket(8'000'000, 1000);  // a megabyte a second
  TokenBucket::Clock::time_point now = kStart;
  for (int i = 0; i < 2001; ++i) now = bucket.take(now, 1000);
  EXPECT_EQ(now, kStart + seconds(2));
}

TEST(TokenBucket, SavesNoMoreThanItsBurst) {
  TokenBucket bucket(8'000'000, 5000);
  bucket.take(kStart, 5000);
  const auto later = kStart + seconds(100);
  EXPECT_EQ(bucket.take(later, 5000), later);
  EXPECT_EQ(bucket.take(later, 1000), later + milliseconds(1));
}

TEST(TokenBucket, DoesNotHoldUpWithoutARate) {
  TokenBucket bucket(0, 1);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(bucket.take(kStart, UINT64_C(1) << 40), kStart);
}

}  // namespace
}  // namespace pmesh::test
