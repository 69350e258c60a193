#include "server/net/listener.h"

#include <cerrno>
#include <sstream>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include "server/net/endpoint.h"

namespace pmesh {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr std::chrono::milliseconds kPauseAfterError{100};

Error listen_error(const std::string& address, const error_code& error) {
  const bool exhausted = error == asio::error::no_descriptors || error == asio::error::no_memory ||
                         error == boost::system::errc::too_many_files_open_in_system ||
                         error == asio::error::no_buffer_space;
  return {exhausted ? ErrorCode::out_of_resources : ErrorCode::runtime,
          address + ": cannot listen: " + error.message()};
}

}  // namespace

Result<std::shared_ptr<Listener>> Listener::bind(Reactors& reactors, const std::string& address,
                                                 Door sessions, Door refusals) {
  const auto endpoint = parse_endpoint(address);
  if (!endpoint) return endpoint.error();
  std::shared_ptr<Listener> listener(
      new Listener(reactors, std::move(sessions), std::move(refusals)));
  listener->protocol_ = endpoint->protocol();
  Acceptor& acceptor = listener->acceptor_;
  error_code error;
  acceptor.open(endpoint->protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(*endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (!error) acceptor.non_blocking(true, error);
  if (error) return listen_error(address, error);
  return listener;
}

Listener::Connection::~Connection() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Listener::Listener(Reactors& reactors, Door sessions, Door refusals)
    : reactors_(reactors),
      acceptor_(reactors.first()),
      sessions_(std::move(sessions)),
      refusals_(std::move(refusals)) {}

std::string Listener::address() const {
  error_code error;
  std::ostringstream text;
  text << acceptor_.local_endpoint(error);
  return text.str();
}

void Listener::start() {
  asio::co_spawn(
      acceptor_.get_executor(),
      [self = shared_from_this()]() -> Awaitable<void> { co_await self->accept_all(); },
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

Awaitable<void> Listener::accept_all() {
  Timer pause(acceptor_.get_executor());
  while (acceptor_.is_open()) {
    const auto [wait_error] = co_await acceptor_.async_wait(asio::socket_base::wait_read, kAwait);
    if (wait_error) continue;
    const int failure = accept_waiting();
    if (failure == 0) continue;
    // Out of descriptors, most likely: the connection stays queued, and trying at once would spin.
    spdlog::warn("cannot accept a connection: {}",
                 error_code(failure, asio::error::get_system_category()).message());
    pause.expires_after(kPauseAfterError);
    co_await pause.async_wait(kAwait);
  }
}

/// Hands the connections that wait to the reactors in turn. Gives the number of the error that
/// keeps it from going on; 0 if there are no more.
int Listener::accept_waiting() {
  while (true) {
    const int descriptor =
        ::accept4(acceptor_.native_handle(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (descriptor < 0) {
      if (errno == EINTR || errno == ECONNABORTED) continue;
      return errno == EAGAIN || errno == EWOULDBLOCK ? 0 : errno;
    }
    asio::io_context& context = reactors_.next();
    asio::post(context, [self = shared_from_this(), &context,
                         connection = Connection(descriptor)]() mutable {
      self->take(context, std::move(connection));
    });
  }
}

/// Starts the connection's session on its own thread; without memory for one it is closed.
void Listener::take(asio::io_context& context, Connection connection) {
  try {
    Socket socket(context, protocol_, connection.get());
    connection.release();
    const auto session = sessions_.registry.full() ? nullptr : sessions_.make_session(socket);
    if (session) return sessions_.registry.start(session);
    if (refusals_.registry.full()) return;
    refusals_.registry.start(refusals_.make_session(socket));
  } catch (...) {
    log_exception("starting a session", std::current_exception());
  }
}

}  // namespace pmesh
