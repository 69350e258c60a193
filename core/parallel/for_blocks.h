// A loop over blocks of indices on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <system_error>
#include <thread>
#include <vector>

namespace pmesh {

/// Calls work(begin, end) for blocks that cover [0, count), each once, on up to `threads` threads,
/// the caller's included. Every block begins at a multiple of kBlock and, but for the last, is as
/// long. `work` must not throw, and its blocks must not depend on each other.
template <std::uint64_t kBlock = 1 << 12, class Work>
void for_blocks(std::uint32_t count, unsigned threads, const Work& work) {
  std::atomic<std::uint64_t> cursor = 0;
  const auto run = [&] {
    while (true) {
      const std::uint64_t begin = cursor.fetch_add(kBlock);
      if (begin >= count) return;
      work(static_cast<std::uint32_t>(begin),
           static_cast<std::uint32_t>(std::min<std::uint64_t>(begin + kBlock, count)));
    }
  };
  std::vector<std::jthread> helpers;
  try {
    while (helpers.size() + 1 < threads && helpers.size() * kBlock < count) {
      helpers.emplace_back(run);
    }
  } catch (const std::system_error&) {  // The system has no thread to give: fewer do the work.
  }
  run();
}

}  // namespace pmesh
