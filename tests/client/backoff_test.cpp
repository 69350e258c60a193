#include "client/backoff.h"

#include <vector>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

using std::chrono::milliseconds;

constexpr RetryPolicy kPolicy{.first_delay = milliseconds(100),
                              .longest_delay = milliseconds(1000),
                              .longest_retry_after = milliseconds(5000),
                              .seed = 1};

TEST(Backoff, DoublesUpToItsLimitAndTakesOffAtMostHalf) {
  Backoff backoff(kPolicy);
  for (const int most : {100, 200, 400, 800, 1000, 1000, 1000}) {
    const milliseconds wait = backoff.next({});
    EXPECT_LE(wait, milliseconds(most));
    EXPECT_GE(wait, milliseconds(most / 2));
  }
}

TEST(Backoff, BeginsAnewAfterAReset) {
  Backoff backoff(kPolicy);
  for (int i = 0; i < 5; ++i) backoff.next({});
  backoff.reset();
  EXPECT_LE(backoff.next({}), milliseconds(100));
}

std::vector<milliseconds> waits(std::uint32_t seed) {
  RetryPolicy policy = kPolicy;
  policy.seed = seed;
  Backoff backoff(policy);
  return {backoff.next({}), backoff.next({}), backoff.next({}), backoff.next({})};
}

TEST(Backoff, RepeatsItselfForTheSameSeedOnly) {
  EXPECT_EQ(waits(1), waits(1));
  EXPECT_NE(waits(1), waits(2));
}

TEST(Backoff, WaitsAsLongAsTheHostAsksWithinReason) {
  Backoff backoff(kPolicy);
  EXPECT_EQ(backoff.next(milliseconds(3000)), milliseconds(3000));
  EXPECT_EQ(backoff.next(milliseconds(90'000)), milliseconds(5000));
  EXPECT_GE(backoff.next(milliseconds(0)), milliseconds(200));
}

}  // namespace
}  // namespace pmesh
