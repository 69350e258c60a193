// Lets one coroutine wait until another has something for it.
#pragma once

#include "server/net/asio_types.h"

namespace pmesh {

/// A notify() without a waiter is lost: check what is waited for first. Threads: all on the
/// executor's.
class Signal {
 public:
  explicit Signal(const Executor& executor) : never_(executor, Timer::time_point::max()) {}

  Awaitable<void> wait() { co_await never_.async_wait(kAwait); }
  void notify() { never_.cancel(); }

 private:
  Timer never_;
};

}  // namespace pmesh
