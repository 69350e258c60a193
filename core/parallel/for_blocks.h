// A loop over blocks of indices on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

namespace pmesh {

/// A loop over [0, count) in blocks, for several threads. Each has a part of its own, so that in
/// loops over the same things it meets what it has in its caches; then it helps with the others'.
template <std::uint64_t kBlock>
class BlockLoop {
 public:
  BlockLoop(std::uint32_t count, std::uint32_t parts) : parts_(parts) {
    const std::uint64_t blocks = (count + kBlock - 1) / kBlock;
    for (std::uint64_t i = 0; i < parts; ++i) {
      parts_[i].next = blocks * i / parts * kBlock;
      parts_[i].end = std::min<std::uint64_t>(blocks * (i + 1) / parts * kBlock, count);
    }
  }

  /// Calls work(begin, end) for blocks, part `own` first, until none is left or one has failed.
  /// Does not throw.
  template <class Work>
  void run(std::uint32_t own, const Work& work) {
    try {
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        Part& part = parts_[(own + i) % parts_.size()];
        while (!has_failed_) {
          const std::uint64_t begin = part.next.fetch_add(kBlock);
          if (begin >= part.end) break;
          work(static_cast<std::uint32_t>(begin),
               static_cast<std::uint32_t>(std::min(begin + kBlock, part.end)));
        }
      }
    } catch (...) {
      if (!has_failed_.exchange(true)) failure_ = std::current_exception();
    }
  }

  /// When all calls of run() have returned: throws what one of them has met.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  struct alignas(64) Part {  // a cache line of its own
    std::atomic<std::uint64_t> next = 0;
    std::uint64_t end = 0;
  };

  std::vector<Part> parts_;
  std::atomic<bool> has_failed_ = false;
  std::exception_ptr failure_;
};

/// Calls work(begin, end) for blocks that cover [0, count), each once, on up to `threads` threads,
/// the caller's included. Every block begins at a multiple of kBlock and, but for the last, is as
/// long. Blocks must not depend on each other. What one of them throws (want of memory) is thrown
/// here, after the others have ended; blocks not yet begun are left out then.
template <std::uint64_t kBlock = 1 << 12, class Work>
void for_blocks(std::uint32_t count, unsigned threads, const Work& work) {
  BlockLoop<kBlock> loop(count, 1);
  {
    std::vector<std::jthread> helpers;
    try {
      while (helpers.size() + 1 < threads && (helpers.size() + 1) * kBlock < count) {
        helpers.emplace_back([&] { loop.run(0, work); });
      }
    } catch (const std::exception&) {  // No thread, or no memory for it: fewer do the work.
    }
    loop.run(0, work);
  }
  loop.rethrow();
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
