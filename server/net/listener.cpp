#include "server/net/listener.h"

#include <sstream>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <spdlog/spdlog.h>

#include "core/base/parse_number.h"

namespace pmesh {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
constexpr std::chrono::milliseconds kPauseAfterError{100};
constexpr std::size_t kMostRefusals = 256;

Result<tcp::endpoint> parse_endpoint(const std::string& text) {
  const Error wrong{ErrorCode::usage, text + ": expected ADDRESS:PORT, such as 127.0.0.1:8080"};
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return wrong;
  std::string host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const auto port = parse_whole<std::uint16_t>(std::string_view(text).substr(colon + 1));
  error_code bad_host;
  const auto address = asio::ip::make_address(host, bad_host);
  if (bad_host || !port) return wrong;
  return tcp::endpoint(address, *port);
}

Error listen_error(const std::string& address, const error_code& error) {
  const bool exhausted = error == asio::error::no_descriptors || error == asio::error::no_memory ||
                         error == boost::system::errc::too_many_files_open_in_system ||
                         error == asio::error::no_buffer_space;
  return {exhausted ? ErrorCode::out_of_resources : ErrorCode::runtime,
          address + ": cannot listen: " + error.message()};
}

}  // namespace

Result<std::shared_ptr<Listener>> Listener::bind(asio::io_context& context,
                                                 const std::string& address,
                                                 SessionRegistry& registry,
                                                 MakeSession make_session,
                                                 MakeSession make_refusal) {
  const auto endpoint = parse_endpoint(address);
  if (!endpoint) return endpoint.error();
  std::shared_ptr<Listener> listener(
      new Listener(context, registry, std::move(make_session), std::move(make_refusal)));
  tcp::acceptor& acceptor = listener->acceptor_;
  error_code error;
  acceptor.open(endpoint->protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(*endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return listen_error(address, error);
  return listener;
}

Listener::Listener(asio::io_context& context, SessionRegistry& registry, MakeSession make_session,
                   MakeSession make_refusal)
    : context_(context),
      acceptor_(asio::make_strand(context)),
      registry_(registry),
      make_session_(std::move(make_session)),
      make_refusal_(std::move(make_refusal)),
      refusals_(kMostRefusals) {}

std::string Listener::address() const {
  error_code error;
  std::ostringstream text;
  text << acceptor_.local_endpoint(error);
  return text.str();
}

void Listener::start() {
  asio::co_spawn(
      acceptor_.get_executor(),
      [self = shared_from_this()]() -> asio::awaitable<void> { co_await self->accept_all(); },
      [](const std::exception_ptr& exception) {
        if (exception) log_exception("accepting connections", exception);
      });
}

void Listener::stop() {
  asio::post(acceptor_.get_executor(), [self = shared_from_this()] {
    error_code ignored;
    self->acceptor_.close(ignored);
  });
}

asio::awaitable<void> Listener::accept_all() {
  asio::steady_timer pause(acceptor_.get_executor());
  while (acceptor_.is_open()) {
    auto [error, socket] = co_await acceptor_.async_accept(asio::make_strand(context_), kAwait);
    if (!error) {
      take(std::move(socket));
    } else if (acceptor_.is_open() && error != asio::error::connection_aborted) {
      // Out of descriptors, most likely: the connection stays queued, and trying at once would
      // spin.
      spdlog::warn("cannot accept a connection: {}", error.message());
      pause.expires_after(kPauseAfterError);
      co_await pause.async_wait(kAwait);
    }
  }
}

/// Starts the connection's session; without memory for one the connection is closed.
void Listener::take(tcp::socket socket) {
  try {
    if (!registry_.full()) {
      registry_.start(make_session_(std::move(socket)));
    } else if (!refusals_.full()) {
      refusals_.start(make_refusal_(std::move(socket)));
    }
  } catch (...) {
    log_exception("starting a session", std::current_exception());
  }
}

}  // namespace pmesh
