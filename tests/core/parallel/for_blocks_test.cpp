#include "core/parallel/for_blocks.h"

#include <gtest/gtest.h>

namespace pmesh {
namespace {

TEST(ForBlocks, VisitsEveryIndexOnce) {
  for (const std::uint32_t count : {0u, 1u, 4'096u, 100'001u}) {
    for (const unsigned threads : {1u, 3u}) {
      std::vector<std::uint8_t> visits(count, 0);
      for_blocks(count, threads, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) ++visits[i];
      });
      EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), count);
    }
  }
}

TEST(ForBlocks, ThrowsWhatABlockThrows) {
  for (const unsigned threads : {1u, 4u}) {
    const auto work = [](std::uint32_t begin, std::uint32_t) {
      if (begin >= 40'960) throw std::bad_alloc();
    };
    EXPECT_THROW(for_blocks(100'001, threads, work), std::bad_alloc);
  }
}

TEST(RunBoth, RunsBoth) {
  for (const unsigned threads : {1u, 2u}) {
    int first = 0, second = 0;
    run_both(
        threads, [&] { first = 1; }, [&] { second = 2; });
    EXPECT_EQ(first + second, 3);
  }
}

}  // namespace
}  // namespace pmesh
