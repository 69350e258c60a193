#include "client/connection.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <optional>

#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>

namespace pmesh {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

namespace {

bool is_address(const std::string& host) {
  error_code error;
  asio::ip::make_address(host, error);
  return !error;
}

// Whom to trust: TLS 1.2 or later, and the authorities of `ca_file` or the system's.
error_code set_up(ssl::context& context, const std::string& ca_file) {
  error_code error;
  context.set_options(
      ssl::context::default_workarounds | ssl::context::no_tlsv1 | ssl::context::no_tlsv1_1, error);
  context.set_verify_mode(ssl::verify_peer, error);
  if (ca_file.empty()) {
    context.set_default_verify_paths(error);
  } else {
    context.load_verify_file(ca_file, error);
  }
  return error;
}

}  // namespace

struct Connection::Impl {
  using TlsStream = ssl::stream<tcp::socket&>;

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

  TransportStatus find(const Endpoint& endpoint, tcp::resolver::results_type& addresses) {
    return run(options.connect_timeout, "finding the host", [&](auto handler) {
      resolver.async_resolve(endpoint.host, std::to_string(endpoint.port),
                             tcp::resolver::numeric_service,
                             [&addresses, handler](error_code error, auto results) mutable {
                               addresses = std::move(results);
                               handler(error);
                             });
    });
  }

  TransportStatus connect_tls(const std::string& host) {
    if (!trust) {
      trust.emplace(ssl::context::tls_client);
      if (const error_code error = set_up(*trust, options.ca_file)) {
        trust.reset();
        close();
        return final_error({ErrorCode::usage, options.ca_file + ": " + error.message()});
      }
    }
    tls = std::make_unique<TlsStream>(socket, *trust);
    error_code error;
    tls->set_verify_callback(ssl::host_name_verification(host), error);
    // A server with several certificates chooses by this name; an address is none (RFC 6066).
    if (!is_address(host)) SSL_set_tlsext_host_name(tls->native_handle(), host.c_str());
    TransportStatus failed = run(options.connect_timeout, "TLS", [&](auto handler) {
      tls->async_handshake(ssl::stream_base::client, handler);
    });
    if (!failed) return std::nullopt;
    const long verdict = SSL_get_verify_result(tls->native_handle());
    if (verdict == X509_V_OK) return failed;
    return final_error(runtime_error(peer + ": its certificate is not to be trusted: " +
                                     X509_verify_cert_error_string(verdict)));
  }

  TransportOptions options;
  std::string peer;
  asio::io_context context{1};
  tcp::socket socket{context};
  tcp::resolver resolver{context};
  std::optional<ssl::context> trust;
  std::unique_ptr<TlsStream> tls;  // null: the connection is plain
};

Connection::Connection(const TransportOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Connection::~Connection() = default;

bool Connection::is_open() const { return impl_->socket.is_open(); }
void Connection::close() { impl_->close(); }

TransportStatus Connection::connect(const Endpoint& endpoint) {
  Impl& impl = *impl_;
  impl.close();
  impl.tls.reset();
  impl.peer = endpoint.text();
  tcp::resolver::results_type addresses;
  if (auto failed = impl.find(endpoint, addresses)) return failed;
  TransportStatus failed = impl.run(impl.options.connect_timeout, "connecting", [&](auto handler) {
    asio::async_connect(impl.socket, addresses, handler);
  });
  if (failed) return failed;
  error_code ignored;
  impl.socket.set_option(tcp::no_delay(true), ignored);
  return endpoint.is_secure ? impl.connect_tls(endpoint.host) : std::nullopt;
}

TransportStatus Connection::write(ByteView bytes) {
  assert(is_open());
  const asio::const_buffer buffer = asio::buffer(bytes.data(), bytes.size());
  return impl_->run(impl_->options.idle_timeout, "sending", [&](auto handler) {
    if (impl_->tls) {
      asio::async_write(*impl_->tls, buffer, handler);
    } else {
      asio::async_write(impl_->socket, buffer, handler);
    }
  });
}

TransportStatus Connection::read_some(std::span<std::uint8_t> buffer, std::size_t& count) {
  assert(is_open());
  count = 0;
  return impl_->run(impl_->options.idle_timeout, "receiving", [&](auto handler) {
    auto on_read = [&count, handler](error_code error, std::size_t bytes) mutable {
      count = bytes;
      handler(error == asio::error::eof ? error_code() : error);
    };
    if (impl_->tls) {
      impl_->tls->async_read_some(asio::buffer(buffer.data(), buffer.size()), on_read);
    } else {
      impl_->socket.async_read_some(asio::buffer(buffer.data(), buffer.size()), on_read);
    }
  });
}

}  // namespace pmesh
