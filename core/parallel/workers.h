// Threads that stay, for loops too short to start any for.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

#include "core/parallel/for_blocks.h"

namespace pmesh {

/// Not to be used by two threads at the same time.
class Workers {
 public:
  /// `threads` in all, the caller's included; fewer if the system has none to give.
  explicit Workers(unsigned threads) {
    helpers_.reserve(threads);
    try {
      while (helpers_.size() + 1 < threads) helpers_.emplace_back([this, i = count()] { help(i); });
    } catch (const std::exception&) {  // No thread, or no memory for it. Those there are must not
    }                                  // be left waiting.
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers() { start(nullptr, nullptr); }

  /// How many there are, the caller included.
  std::uint32_t count() const { return static_cast<std::uint32_t>(helpers_.size()) + 1; }

  /// Calls work(i) at the same time on the caller's thread, for which i is 0, and on those others
  /// that come before that call has returned, i below count() being the thread's number; returns
  /// when all have returned. So nobody waits for a thread that the system keeps from running. A
  /// thread may be called twice. `work` must not throw.
  template <class Work>
  void run(const Work& work) {
    start([](const void* called, std::uint32_t i) { (*static_cast<const Work*>(called))(i); },
          &work);
    work(0);
    inside_ &= ~kOpen;
    for (std::uint32_t left = inside_; left != 0; left = inside_) await_change(inside_, left);
  }

 private:
  using Call = void (*)(const void* work, std::uint32_t thread);
  static constexpr std::uint32_t kOpen = 1u << 31;

  // Only while nobody is inside, which is when call_ and work_ may be written.
  void start(Call call, const void* work) {
    call_ = call;
    work_ = work;
    inside_ = kOpen;
    ++round_;
    round_.notify_all();
  }

  void help(std::uint32_t thread) {
    for (std::uint32_t seen = 0;;) {
      await_change(round_, seen);
      seen = round_;
      if (!enter()) continue;
      if (call_ == nullptr) return;
      call_(work_, thread);
      if (--inside_ == 0) inside_.notify_one();
    }
  }

  bool enter() {
    std::uint32_t inside = inside_;
    while ((inside & kOpen) != 0) {
      if (inside_.compare_exchange_weak(inside, inside + 1)) return true;
    }
    return false;
  }

  // Tries for a while before it sleeps: what comes next mostly comes soon.
  static void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
    constexpr int kTries = 2000;
    for (int i = 0; i < kTries; ++i) {
      if (value != old) return;
      std::this_thread::yield();
    }
    value.wait(old);
  }

  std::atomic<std::uint32_t> round_ = 0;
  std::atomic<std::uint32_t> inside_ = 0;  // helpers in work_; kOpen: others may still come
  Call call_ = nullptr;                    // null: the end
  const void* work_ = nullptr;
  std::vector<std::jthread> helpers_;
};

/// for_blocks() by `workers`; calls work(begin, end, the thread's number).
template <std::uint64_t kBlock = 1 << 9, class Work>
void for_blocks(std::uint32_t count, Workers& workers, const Work& work) {
  BlockLoop<kBlock> loop(count, workers.count());
  const auto run = [&](std::uint32_t thread) {
    loop.run(thread, [&](std::uint32_t begin, std::uint32_t end) { work(begin, end, thread); });
  };
  if (count <= kBlock || workers.count() == 1) {
    run(0);
  } else {
    workers.run(run);
  }
  loop.rethrow();
}

/// Lists element(i) for all i in [0, count) that keep(i) is true of, in their order.
template <class T, class Element, class Keep>
void filter(std::uint32_t count, std::vector<T>& list, Workers& workers, const Element& element,
            const Keep& keep) {
  constexpr std::uint32_t kBlock = 1 << 11;
  std::vector<std::uint32_t> kept(count / kBlock + 1, 0);
  list.resize(count);
  for_blocks<kBlock>(count, workers, [&](std::uint32_t begin, std::uint32_t end, std::uint32_t) {
    std::uint32_t left = begin;
    for (std::uint32_t i = begin; i < end; ++i) {  // without a branch that nobody could guess
      list[left] = element(i);
      left += keep(i) ? 1 : 0;
    }
    kept[begin / kBlock] = left - begin;
  });
  auto end = list.begin();
  for (std::size_t block = 0; block < kept.size(); ++block) {
    const auto begin = list.begin() + static_cast<std::ptrdiff_t>(block * kBlock);
    end = std::copy(begin, begin + kept[block], end);
  }
  list.erase(end, list.end());
}

}  // namespace pmesh
