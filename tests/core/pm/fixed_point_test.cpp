#include "core/pm/fixed_point.h"

#include <random>

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(FixedPoint, DividesToTheNearestIntegerHalvesUp) {
  EXPECT_EQ(divide(7, 2), 4);
  EXPECT_EQ(divide(-7, 2), -3);
  EXPECT_EQ(divide(5, 3), 2);
  EXPECT_EQ(divide(-5, 3), -2);
  EXPECT_EQ(divide(0, 9), 0);
  EXPECT_EQ(divide(Vec3l{1, -1, 3}, 2), (Vec3l{1, 0, 2}));
}

TEST(FixedPoint, AQuotientIsNeverMoreThanHalfOff) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 100'000; ++n) {
    const auto a = static_cast<std::int64_t>(random()) >> (5 + random() % 58);
    const auto b = 1 + static_cast<std::int64_t>(random() >> (6 + random() % 57));
    const std::int64_t off = 2 * (divide(a, b) * b - a);
    ASSERT_TRUE(-b < off && off <= b) << a << " / " << b;
  }
}

void expect_root(std::int64_t value) {
  const std::int64_t root = square_root(value);
  EXPECT_LE(root * root, value);
  EXPECT_GT((root + 1) * (root + 1), value);
}

TEST(FixedPoint, TakesSquareRootsExactlyAtAndBesideEverySquare) {
  constexpr std::int64_t kLast = (std::int64_t{1} << 26) - 1;
  for (std::int64_t root = 1; root <= kLast; root += 1 + root / 5000) {
    for (const std::int64_t beside : {-1, 0, 1}) expect_root(root * root + beside);
  }
  for (const std::int64_t beside : {-1, 0, 1}) expect_root(kLast * kLast + beside);
  expect_root((std::int64_t{1} << 52) - 1);
  expect_root(0);
}

TEST(FixedPoint, CountsTheBitsOfAMagnitude) {
  EXPECT_EQ(bit_length(0), 0);
  EXPECT_EQ(bit_length(1), 1);
  EXPECT_EQ(bit_length(-2), 2);
  EXPECT_EQ(bit_length(3), 2);
  EXPECT_EQ(bit_length(-(std::int64_t{1} << 40)), 41);
}

TEST(FixedPoint, HalfOctavesStepAtPowersOfTwoAndHalfWayBetween) {
  const int expected[] = {0, 2, 4, 5, 6, 6, 7, 7, 8, 8, 8, 8, 9};
  for (std::int64_t value = 0; value < 13; ++value) EXPECT_EQ(half_octaves(value), expected[value]);
  for (int bits = 2; bits < 50; ++bits) {
    EXPECT_EQ(half_octaves(std::int64_t{1} << bits), 2 * bits + 2);
    EXPECT_EQ(half_octaves((std::int64_t{3} << (bits - 1)) - 1), 2 * bits + 2);
    EXPECT_EQ(half_octaves(std::int64_t{3} << (bits - 1)), 2 * bits + 3);
  }
}

TEST(FixedPoint, MeasuresAndClampsVectors) {
  const Vec3l a{3, -5, 4};
  EXPECT_EQ(manhattan(a), 12);
  EXPECT_EQ(largest(a), 5);
  EXPECT_EQ(clamp_to(a, 4), (Vec3l{3, -4, 4}));
  EXPECT_EQ(shift_right(a, 1), (Vec3l{1, -3, 2}));
}

}  // namespace
}  // namespace pmesh
