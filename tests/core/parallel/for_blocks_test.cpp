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

}  // namespace
}  // namespace pmesh
