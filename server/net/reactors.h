// The threads that serve: an io_context each. A connection belongs to one of them from accept to
// close, so its handlers need no strand and its socket no lock (docs/decisions/0016). The other
// side of that: sockets and timers may be touched, made and destroyed by their own thread alone;
// only post() may cross.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>

#include "server/net/asio_types.h"

namespace pmesh {

/// Threads: next() and stop() may be called on any thread; the rest before run().
class Reactors {
 public:
  /// `threads` io_contexts; 0 means as many as the machine has cores.
  explicit Reactors(unsigned threads);
  /// Handlers that never ran may hold a listener, which belongs to the first: that goes last.
  /// Precondition: nobody else holds a socket or timer.
  ~Reactors();

  /// Whose turn it is to take a connection.
  boost::asio::io_context& next();
  /// The one for what there is only one of: listeners, signals.
  boost::asio::io_context& first() { return *contexts_.front(); }

  /// Runs all of them, the first on the calling thread, until stop().
  void run();
  void stop();

 private:
  static void run(boost::asio::io_context& context);

  using Work = boost::asio::executor_work_guard<Executor>;

  std::vector<std::unique_ptr<boost::asio::io_context>> contexts_;
  std::vector<Work> work_;
  std::atomic<std::size_t> turn_ = 0;
};

}  // namespace pmesh
