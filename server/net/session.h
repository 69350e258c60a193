// What the sessions of either protocol have in common: a channel, whom it leads to, and an orderly
// end.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/net/asio_types.h"
#include "server/net/channel.h"
#include "server/services.h"

namespace pmesh {

/// Logs what ended a coroutine: "`what` failed: ...".
void log_exception(std::string_view what, const std::exception_ptr& exception);

/// One connection from accept to close. It lives as long as its coroutine runs.
class Session : public std::enable_shared_from_this<Session> {
 public:
  /// `slot` is the place that the peer has among its address's connections; a trusted proxy needs
  /// none for itself.
  Session(Socket socket, Services& services, WireProtocol protocol, AddressCounts::Slot slot);
  virtual ~Session();

  /// Runs the session to its end; `ended` is called then, on any thread. Throws if memory is short;
  /// then `ended` is not called.
  void start(std::function<void()> ended);

  /// Any thread: finish what is under way, begin nothing new.
  void drain();
  /// Any thread: end now.
  void cut();

 protected:
  /// The whole session, on the channel's thread. In coroutines let co_await stand in a statement of
  /// its own or initialise a variable, never in a condition or after co_return, and give what it
  /// awaits no brace-made temporaries: g++ 12 miscompiles some of those.
  virtual Awaitable<void> run() = 0;
  /// On the channel's thread, once draining() has become true: wake up whoever waits for the peer.
  virtual void on_drain() = 0;
  /// What a client is told that has too many connections already.
  virtual std::string refusal() const = 0;

  bool draining() const { return draining_; }
  Services& services() const { return services_; }
  Metrics& metrics() const { return services_.metrics; }
  /// As it stood when the connection began, or when refresh_policy() was last called.
  const Policy& policy() const { return *policy_; }
  const PolicyPtr& policy_pointer() const { return policy_; }
  const SessionLimits& limits() const { return policy_->limits; }
  void refresh_policy();
  /// Who has connected, or for whom a trusted proxy has.
  const boost::asio::ip::address& client() const { return client_; }

  /// From now on the connection counts as one of this protocol.
  void become(WireProtocol protocol);
  /// Counts what was sent since the last time.
  void count_sent_bytes();

 private:
  enum class Welcome : std::uint8_t {
    yes,
    no,       // to be told why
    unheard,  // not even that: it broke the rules or went away
  };

  Awaitable<void> live();
  Awaitable<Welcome> take_proxy_header();
  bool enter(const boost::asio::ip::address& client);

  Services& services_;
  std::uint64_t policy_version_;
  PolicyPtr policy_;

 protected:
  Channel channel_;

 private:
  boost::asio::ip::address client_;
  AddressCounts::Slot slot_;
  WireProtocol protocol_;
  std::uint64_t counted_bytes_ = 0;
  bool draining_ = false;
};

}  // namespace pmesh
