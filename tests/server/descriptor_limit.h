// A smaller table of descriptors for as long as an object lives.
#pragma once

#include <cassert>

#include <sys/resource.h>
#include <unistd.h>

namespace pmesh::testing {

class DescriptorLimit {
 public:
  /// Descriptors below `most` only.
  explicit DescriptorLimit(int most) {
    [[maybe_unused]] const int got = ::getrlimit(RLIMIT_NOFILE, &before_);
    assert(got == 0);
    const rlimit smaller{static_cast<rlim_t>(most), before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &smaller);
  }
  ~DescriptorLimit() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  DescriptorLimit(const DescriptorLimit&) = delete;
  DescriptorLimit& operator=(const DescriptorLimit&) = delete;

  /// False under sanitizers, which need descriptors themselves: skip what leaves none.
  static constexpr bool can_leave_none() {
#ifdef PMESH_SANITIZED
    return false;
#else
    return true;
#endif
  }
  /// The least limit with which nothing more can be opened.
  static int none_left() {
    const int lowest = ::dup(STDERR_FILENO);
    ::close(lowest);
    return lowest;
  }

 private:
  rlimit before_{};
};

}  // namespace pmesh::testing
