// A point in time by which something must have happened, moved often and reached seldom.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "server/net/asio_types.h"

namespace pmesh {

/// Moving the deadline later is only a store: the timer wakes up at the earliest point set since
/// and then goes back to sleep. Threads: all on the executor's.
class Deadline : public std::enable_shared_from_this<Deadline> {
 public:
  using Clock = std::chrono::steady_clock;

  /// `reached` runs each time that a deadline passes, until stop().
  Deadline(const Executor& executor, std::function<void()> reached);

  void set(Clock::time_point when);
  void clear() { when_ = Clock::time_point::max(); }
  /// Clears for ever and lets go of `reached`.
  void stop();

 private:
  void sleep();

  Timer timer_;
  std::function<void()> reached_;
  Clock::time_point when_ = Clock::time_point::max();
  Clock::time_point wakes_ = Clock::time_point::max();  // max: no wait is under way
};

}  // namespace pmesh
