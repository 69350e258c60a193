#include "core/pm/adaptive_bit.h"

#include <random>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(AdaptiveBit, StartsAtEvenChances) { EXPECT_EQ(AdaptiveBit().one(), 32768u); }

TEST(AdaptiveBit, LeansToWhatItSaw) {
  AdaptiveBit model;
  for (const bool bit : {true, false}) {
    const std::uint32_t before = model.one();
    model.update(bit);
    EXPECT_EQ(model.one() > before, bit);
  }
}

TEST(AdaptiveBit, IsNeverCertain) {
  AdaptiveBit ones, zeros;
  for (int n = 0; n < 100'000; ++n) {
    ones.update(true);
    zeros.update(false);
    ASSERT_LT(ones.one(), 65536u);
    ASSERT_GT(zeros.one(), 0u);
  }
  EXPECT_GT(ones.one(), 65000u);
  EXPECT_LT(zeros.one(), 500u);
}

TEST(AdaptiveBit, FindsTheChanceOfAnUnevenDecision) {
  std::mt19937 random(1);
  AdaptiveBit model;
  double sum = 0;
  for (int n = 0; n < 20'000; ++n) {
    if (n >= 10'000) sum += model.one();
    model.update(random() % 10 == 0);
  }
  EXPECT_NEAR(sum / 10'000 / 65536, 0.1, 0.02);
}

}  // namespace
}  // namespace pmesh
