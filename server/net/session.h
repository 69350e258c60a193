// What the sessions of either protocol have in common: a channel, and an orderly end.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string_view>

#include <boost/asio/awaitable.hpp>

#include "server/net/channel.h"
#include "server/store/mesh_store.h"
#include "server/options.h"

namespace pmesh {

/// Logs what ended a coroutine: "`what` failed: ...".
void log_exception(std::string_view what, const std::exception_ptr& exception);

/// One connection from accept to close. It lives as long as its coroutine runs.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(boost::asio::ip::tcp::socket socket, const SessionLimits& limits)
      : channel_(std::move(socket), limits), limits_(limits) {}
  virtual ~Session() = default;

  /// Runs the session to its end; `ended` is called then, on any thread. Throws if memory is short;
  /// then `ended` is not called.
  void start(std::function<void()> ended);

  /// Any thread: finish what is under way, begin nothing new.
  void drain();
  /// Any thread: end now.
  void cut();

 protected:
  /// The whole session, on the channel's strand. In coroutines let co_await stand in a statement of
  /// its own or initialise a variable, never in a condition: g++ 12 miscompiles some of those.
  virtual boost::asio::awaitable<void> run() = 0;
  /// On the strand, once draining() has become true: wake up whoever waits for the peer.
  virtual void on_drain() = 0;

  bool draining() const { return draining_; }
  const SessionLimits& limits() const { return limits_; }

  Channel channel_;

 private:
  const SessionLimits& limits_;  // the server's, which outlives it
  bool draining_ = false;
};

/// The sessions that run. Threads: all members may be called at the same time.
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
