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

  /// Binds to "ADDRESS:PORT" ("[::1]:8080" for IPv6). Fails (usage) if that is not an address,
  /// (runtime) if it cannot be bound, (out_of_resources) if there are no descriptors left for it.
  /// `make_session` makes the session of a connection, `make_refusal` that of one that is turned
  /// away or beyond the registry's limit, which should be short; both on the thread that is to run
  /// it.
  static Result<std::shared_ptr<Listener>> bind(Reactors& reactors, const std::string& address,
                                                SessionRegistry& registry, MakeSession make_session,
                                                MakeSession make_refusal);

  /// The address that was bound, with its real port.
  std::string address() const;

  void start();
  void stop();

 private:
  Listener(Reactors& reactors, SessionRegistry& registry, MakeSession make_session,
           MakeSession make_refusal);

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
  SessionRegistry& registry_;
  MakeSession make_session_;
  MakeSession make_refusal_;
  SessionRegistry refusals_;  // beyond its limit connections are closed without a word
};

}  // namespace pmesh
