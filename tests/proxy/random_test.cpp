#include "tests/proxy/random.h"

#include <gtest/gtest.h>

namespace pmesh::test {
namespace {

TEST(Random, RepeatsItselfForTheSameSeedAndConnection) {
  Random first(7, 3), second(7, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(first.next(), second.next());
}

TEST(Random, DiffersBetweenSeedsAndBetweenConnections) {
  EXPECT_NE(Random(7, 3).next(), Random(8, 3).next());
  EXPECT_NE(Random(7, 3).next(), Random(7, 4).next());
}

TEST(Random, KeepsItsBounds) {
  Random random(1, 1);
  for (int i = 0; i < 1000; ++i) EXPECT_LT(random.below(10), 10u);
}

TEST(Random, HasItsChances) {
  Random random(1, 2);
  int hits = 0;
  for (int i = 0; i < 10'000; ++i) hits += random.chance(0.3) ? 1 : 0;
  EXPECT_GT(hits, 2800);
  EXPECT_LT(hits, 3200);
  EXPECT_FALSE(random.chance(0));
  EXPECT_TRUE(random.chance(1));
}

}  // namespace
}  // namespace pmesh::test
