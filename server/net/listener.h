// Accepts connections on one address and starts a session for each.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "core/base/result.h"
#include "server/net/asio_types.h"
#include "server/net/reactors.h"
#include "server/net/session_registry.h"

namespace pmesh {

/// Threads: stop() on any thread while the reactors run; the rest before they run.
class Listener : public std::enable_shared_from_this<Listener> {
 public:
  /// Gives null, and leaves the socket alone, if the connection is to be turned away.
  using MakeSession = std::function<std::shared_ptr<Session>(Socket&)>;

  /// Where connections go: how a session is made, on the thread that is to run it, and where it is
  /// registered. The registry must be gone before the reactors are.
  struct Door {
    SessionRegistry& registry;
    MakeSession make_session;
  };

  /// Binds to "ADDRESS:PORT" ("[::1]:8080" for IPv6). Fails (usage) if that is not an address,
  /// (runtime) if it cannot be bound, (out_of_resources) if there are no descriptors left for it.
  /// Who is turned away from `sessions`, or finds its registry full, goes to `refusals`, whose
  /// sessions should be short; beyond the limit of those connections are closed without a word.
  static Result<std::shared_ptr<Listener>> bind(Reactors& reactors, const std::string& address,
                                                Door sessions, Door refusals);

  /// The address that was bound, with its real port.
  std::string address() const;

  void start();
  void stop();

 private:
  Listener(Reactors& reactors, Door sessions, Door refusals);

  /// An accepted connection on its way to its thread.
  class Connection {
   public:
    explicit Connection(int descriptor) : descriptor_(descriptor) {}
    Connection(Connection&& other) noexcept : descriptor_(other.release()) {}
    Connection& operator=(Connection&&) = delete;
    ~Connection();

    int get() const { return descriptor_; }
    int release() { return std::exchange(descriptor_, -1); }

   private:
    int descriptor_;
  };

  Awaitable<void> accept_all();
  int accept_waiting();
  void take(boost::asio::io_context& context, Connection connection);

  Reactors& reactors_;
  boost::asio::ip::tcp protocol_ = boost::asio::ip::tcp::v4();
  Acceptor acceptor_;
  Door sessions_;
  Door refusals_;
};

}  // namespace pmesh
