#include "server/net/session.h"

#include <array>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <spdlog/spdlog.h>

#include "server/net/proxy_header.h"

namespace pmesh {

namespace asio = boost::asio;

namespace {

/// Between two looks at a PROXY header that has not come whole.
constexpr std::chrono::milliseconds kProxyHeaderPause{5};

}  // namespace

void log_exception(std::string_view what, const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const std::exception& error) {
    spdlog::error("{} failed: {}", what, error.what());
  } catch (...) {
    spdlog::error("{} failed", what);
  }
}

Session::Session(Socket socket, Services& services, WireProtocol protocol, AddressCounts::Slot slot)
    : services_(services),
      policy_version_(services.policy.version()),
      policy_(services.policy.get()),
      channel_(std::move(socket), policy_->limits),
      client_(channel_.peer()),
      slot_(std::move(slot)),
      protocol_(protocol) {
  metrics().accepted.add(protocol_);
  metrics().open.add(protocol_);
}

Session::~Session() {
  count_sent_bytes();
  if (channel_.send_timed_out()) metrics().limits.add(LimitName::send_timeout);
  metrics().open.subtract(protocol_);
}

void Session::start(std::function<void()> ended) {
  asio::co_spawn(
      channel_.executor(), live(),
      [self = shared_from_this(), ended = std::move(ended)](const std::exception_ptr& exception) {
        if (exception) log_exception("a session", exception);
        self->channel_.close();
        ended();
      });
}

Awaitable<void> Session::live() {
  Welcome welcome = Welcome::yes;
  if (services_.proxies.contains(client_)) welcome = co_await take_proxy_header();
  if (welcome == Welcome::unheard) co_return;
  if (policy_->tls) {
    const auto by = Deadline::Clock::now() + limits().header_timeout;
    const bool is_secure = co_await channel_.start_tls(*policy_->tls, by);
    if (channel_.timed_out()) metrics().limits.add(LimitName::header_timeout);
    if (!is_secure) co_return;
  }
  if (welcome == Welcome::yes) {
    co_await run();
    co_return;
  }
  metrics().limits.add(LimitName::connections_per_address);
  const std::string text = refusal();
  const Channel::Parcel parcel{as_bytes(text)};
  const bool sent = co_await channel_.send(parcel);
  if (sent) co_await channel_.close_gently();
}

/// Of a trusted proxy, which may send one or not. Waiting for the rest of a header looks again and
/// again: a proxy sends it in one piece.
Awaitable<Session::Welcome> Session::take_proxy_header() {
  const auto by = Deadline::Clock::now() + limits().header_timeout;
  std::array<char, kMaxProxyHeaderBytes> bytes;
  Timer pause(channel_.executor());
  const bool arrived = co_await channel_.wait_for_bytes(by);
  ProxyHeader header{arrived ? ProxyHeader::more : ProxyHeader::bad, 0, {}};
  while (header.kind == ProxyHeader::more && Deadline::Clock::now() < by) {
    const std::span<char> held = channel_.peek(bytes);
    if (held.empty()) co_return Welcome::unheard;
    header = parse_proxy_header({held.data(), held.size()});
    if (header.kind != ProxyHeader::more) break;
    pause.expires_after(kProxyHeaderPause);
    co_await pause.async_wait(kAwait);
  }
  if (header.kind == ProxyHeader::none) co_return Welcome::yes;
  if (header.kind == ProxyHeader::more || channel_.timed_out()) {
    metrics().limits.add(LimitName::header_timeout);
  }
  if (header.kind != ProxyHeader::header) co_return Welcome::unheard;
  co_await channel_.receive(std::span(bytes).first(header.bytes), by);
  const bool has_place = !header.client || enter(unmapped(*header.client));
  co_return has_place ? Welcome::yes : Welcome::no;
}

/// Takes a place among the connections of the client that a proxy speaks for, if there is one.
bool Session::enter(const asio::ip::address& client) {
  client_ = client;
  auto slot = services_.addresses.enter(client);
  if (slot) slot_ = std::move(*slot);
  return slot.has_value();
}

void Session::drain() {
  asio::post(channel_.executor(), [self = shared_from_this()] {
    self->draining_ = true;
    self->on_drain();
  });
}

void Session::cut() {
  asio::post(channel_.executor(), [self = shared_from_this()] { self->channel_.reset(); });
}

void Session::refresh_policy() {
  const std::uint64_t version = services_.policy.version();
  if (version == policy_version_) return;
  policy_version_ = version;
  policy_ = services_.policy.get();
}

void Session::become(WireProtocol protocol) {
  count_sent_bytes();
  metrics().open.subtract(protocol_);
  protocol_ = protocol;
  metrics().open.add(protocol_);
  metrics().accepted.add(protocol_);
}

void Session::count_sent_bytes() {
  const std::uint64_t sent = channel_.sent_bytes();
  metrics().sent_bytes.add(protocol_, sent - counted_bytes_);
  counted_bytes_ = sent;
}

}  // namespace pmesh
