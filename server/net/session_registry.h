// The sessions that run.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>

#include "server/net/session.h"

namespace pmesh {

/// Threads: all members may be called at the same time.
class SessionRegistry {
 public:
  explicit SessionRegistry(std::size_t most) : most_(most) {}

  bool full() const { return count_.load() >= most_; }
  std::size_t count() const { return count_.load(); }

  /// Registers the session and starts it; it is let go when it ends. While draining it is drained
  /// at once. Throws if memory is short; then it is not registered.
  void start(const std::shared_ptr<Session>& session);

  /// Drains all sessions; `emptied` is called, on any thread, when the last has ended, at once if
  /// there are none.
  void drain(std::function<void()> emptied);
  void cut();

 private:
  void remove(const std::shared_ptr<Session>& session);

  const std::size_t most_;
  std::atomic<std::size_t> count_ = 0;
  std::mutex mutex_;  // guards the two below
  std::set<std::shared_ptr<Session>> sessions_;
  std::function<void()> emptied_;  // set while draining
};

}  // namespace pmesh
