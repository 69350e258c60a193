// Accepts connections on one address and starts a session for each.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "core/base/result.h"
#include "server/net/session.h"

namespace pmesh {

/// Threads: stop() on any thread while the io_context runs; the rest before it runs.
class Listener : public std::enable_shared_from_this<Listener> {
 public:
  using MakeSession = std::function<std::shared_ptr<Session>(boost::asio::ip::tcp::socket)>;

  /// Binds to "ADDRESS:PORT" ("[::1]:8080" for IPv6). Fails (usage) if that is not an address,
  /// (runtime) if it cannot be bound, (out_of_resources) if there are no descriptors left for it.
  /// `make_session` makes the session of a connection,
  /// `make_refusal` that of one beyond the registry's limit, which should be short.
  static Result<std::shared_ptr<Listener>> bind(boost::asio::io_context& context,
                                                const std::string& address,
                                                SessionRegistry& registry, MakeSession make_session,
                                                MakeSession make_refusal);

  /// The address that was bound, with its real port.
  std::string address() const;

  void start();
  void stop();

 private:
  Listener(boost::asio::io_context& context, SessionRegistry& registry, MakeSession make_session,
           MakeSession make_refusal);

  boost::asio::awaitable<void> accept_all();
  void take(boost::asio::ip::tcp::socket socket);

  boost::asio::io_context& context_;
  boost::asio::ip::tcp::acceptor acceptor_;
  SessionRegistry& registry_;
  MakeSession make_session_;
  MakeSession make_refusal_;
  SessionRegistry refusals_;  // beyond its limit connections are closed without a word
};

}  // namespace pmesh
