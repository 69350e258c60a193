#include "core/parallel/workers.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(Workers, VisitEveryIndexOnceLoopAfterLoop) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Workers workers(threads);
    for (const std::uint32_t count : {0u, 1u, 512u, 513u, 100'001u, 3u, 2'000u}) {
      std::vector<std::uint8_t> visits(count, 0);
      for_blocks(count, workers, [&](std::uint32_t begin, std::uint32_t end, std::uint32_t thread) {
        ASSERT_LT(thread, workers.count());
        for (std::uint32_t i = begin; i < end; ++i) ++visits[i];
      });
      EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), count);
    }
  }
}

TEST(Workers, ThrowWhatABlockThrowsAndGoOn) {
  Workers workers(3);
  for (int round = 0; round < 2; ++round) {
    const auto work = [](std::uint32_t begin, std::uint32_t, std::uint32_t) {
      if (begin >= 40'960) throw std::bad_alloc();
    };
    EXPECT_THROW(for_blocks(100'001, workers, work), std::bad_alloc);
  }
}

TEST(Filter, KeepsTheOrder) {
  for (const unsigned threads : {1u, 3u}) {
    Workers workers(threads);
    std::vector<std::uint32_t> squares;
    filter(
        10'000, squares, workers, [](std::uint32_t i) { return i * i; },
        [](std::uint32_t i) { return i % 7 == 0; });
    ASSERT_EQ(squares.size(), 10'000u / 7 + 1);
    for (std::uint32_t i = 0; i < squares.size(); ++i) EXPECT_EQ(squares[i], 49 * i * i);
  }
}

}  // namespace
}  // namespace pmesh
