#include "client/connection.h"

#include <algorithm>
#include <cassert>
#include <chrono>

#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

namespace pmesh {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

struct Connection::Impl {
  explicit Impl(const TransportOptions& wanted) : options(wanted) {}

  bool is_cancelled() const { return options.cancel != nullptr && options.cancel->load(); }

  void close() {
    error_code ignored;
    socket.close(ignored);
    resolver.cancel();
  }

  /// Starts an asynchronous operation by `start(handler)` and runs it to its end, the deadline or a
  /// cancel; on any failure the socket is closed.
  template <class Start>
  TransportStatus run(std::chrono::milliseconds timeout, const char* what, Start&& start) {
    constexpr std::chrono::milliseconds kCancelPoll{100};
    bool done = false;
    error_code result;
    start([&](error_code error, const auto&...) {
      result = error;
      done = true;
    });
    const Clock::time_point deadline = Clock::now() + timeout;
    context.restart();
    while (!done && !is_cancelled() && Clock::now() < deadline) {
      context.run_one_until(std::min(deadline, Clock::now() + kCancelPoll));
    }
    if (done && !result) return std::nullopt;
    const bool timed_out = !done;
    close();
    context.restart();
    context.run();  // the handler refers to this frame: let it run before leaving
    if (is_cancelled()) return final_error(runtime_error("interrupted"));
    if (timed_out) return failure(what, "no answer within the time limit");
    return failure(what, result.message());
  }

  TransportError failure(const char* what, const std::string& why) const {
    return retryable_error(runtime_error(peer + ": " + what + ": " + why));
  }

  TransportOptions options;
  std::string peer;
  asio::io_context context{1};
  tcp::socket socket{context};
  tcp::resolver resolver{context};
};

Connection::Connection(const TransportOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Connection::~Connection() = default;

bool Connection::is_open() const { return impl_->socket.is_open(); }
void Connection::close() { impl_->close(); }

TransportStatus Connection::connect(const Endpoint& endpoint) {
  Impl& impl = *impl_;
  impl.close();
  impl.peer = endpoint.text();
  const auto timeout = impl.options.connect_timeout;
  tcp::resolver::results_type addresses;
  TransportStatus status = impl.run(timeout, "finding the host", [&](auto handler) {
    impl.resolver.async_resolve(endpoint.host, std::to_string(endpoint.port),
                                tcp::resolver::numeric_service,
                                [&addresses, handler](error_code error, auto results) mutable {
                                  addresses = std::move(results);
                                  handler(error);
                                });
  });
  if (status) return status;
  status = impl.run(timeout, "connecting",
                    [&](auto handler) { asio::async_connect(impl.socket, addresses, handler); });
  if (status) return status;
  error_code ignored;
  impl.socket.set_option(tcp::no_delay(true), ignored);
  return std::nullopt;
}

TransportStatus Connection::write(ByteView bytes) {
  assert(is_open());
  return impl_->run(impl_->options.idle_timeout, "sending", [&](auto handler) {
    asio::async_write(impl_->socket, asio::buffer(bytes.data(), bytes.size()), handler);
  });
}

TransportStatus Connection::read_some(std::span<std::uint8_t> buffer, std::size_t& count) {
  assert(is_open());
  count = 0;
  return impl_->run(impl_->options.idle_timeout, "receiving", [&](auto handler) {
    impl_->socket.async_read_some(asio::buffer(buffer.data(), buffer.size()),
                                  [&count, handler](error_code error, std::size_t bytes) mutable {
                                    count = bytes;
                                    handler(error == asio::error::eof ? error_code() : error);
                                  });
  });
}

}  // namespace pmesh
