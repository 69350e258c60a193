// A loop over blocks of indices on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace pmesh {

/// Calls work(begin, end) for blocks that cover [0, count), each once, on up to `threads` threads,
/// the caller's included. Every block begins at a multiple of kBlock and, but for the last, is as
/// long. Blocks must not depend on each other. What one of them throws (want of memory) is thrown
/// here, after the others have ended; blocks not yet begun are left out then.
template <std::uint64_t kBlock = 1 << 12, class Work>
void for_blocks(std::uint32_t count, unsigned threads, const Work& work) {
  std::atomic<std::uint64_t> cursor = 0;
  std::atomic<bool> has_failed = false;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      while (!has_failed) {
        const std::uint64_t begin = cursor.fetch_add(kBlock);
        if (begin >= count) return;
        work(static_cast<std::uint32_t>(begin),
             static_cast<std::uint32_t>(std::min<std::uint64_t>(begin + kBlock, count)));
      }
    } catch (...) {
      if (!has_failed.exchange(true)) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      while (helpers.size() + 1 < threads && helpers.size() * kBlock < count) {
        helpers.emplace_back(run);
      }
    } catch (const std::system_error&) {  // The system has no thread to give: fewer do the work.
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls both, at the same time if `threads` is more than 1.
template <class First, class Second>
void run_both(unsigned threads, const First& first, const Second& second) {
  for_blocks<1>(2, threads, [&](std::uint32_t task, std::uint32_t) {
    if (task == 0) {
      first();
    } else {
      second();
    }
  });
}

/// Calls work(i) for every i in [0, count), likewise.
template <class Work>
void for_each_index(std::size_t count, unsigned threads, const Work& work) {
  for_blocks(static_cast<std::uint32_t>(count), threads,
             [&](std::uint32_t begin, std::uint32_t end) {
               for (std::uint32_t i = begin; i < end; ++i) work(i);
             });
}

}  // namespace pmesh
