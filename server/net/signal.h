// Lets one coroutine wait until another has something for it.
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace pmesh {

/// A notify() without a waiter is lost: check what is waited for first. Threads: all on one strand.
class Signal {
 public:
  template <class Executor>
  explicit Signal(const Executor& executor)
      : never_(executor, boost::asio::steady_timer::time_point::max()) {}

  boost::asio::awaitable<void> wait() {
    co_await never_.async_wait(boost::asio::as_tuple(boost::asio::use_awaitable));
  }
  void notify() { never_.cancel(); }

 private:
  boost::asio::steady_timer never_;
};

}  // namespace pmesh
