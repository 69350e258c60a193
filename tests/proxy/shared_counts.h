// The counts of a proxy, which its thread makes and others read.
#pragma once

#include <cstdint>
#include <mutex>

#include "tests/proxy/proxy.h"

namespace pmesh::test {

/// Threads: any.
class SharedCounts {
 public:
  void add(std::uint64_t ProxyCounts::*count, std::uint64_t amount = 1) {
    const std::lock_guard lock(mutex_);
    counts_.*count += amount;
  }
  ProxyCounts get() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  mutable std::mutex mutex_;
  ProxyCounts counts_;
};

}  // namespace pmesh::test
