#include "client/websocket_wire.h"

#include <optional>
#include <string>
#include <utility>

#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/websocket/error.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "client/connection.h"
#include "client/http_status.h"
#include "protocol/frames.h"

namespace pmesh {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

namespace {

// A Connection as Beast wants a stream to be: blocking, with the Connection's deadlines. Why a call
// has failed stands in `failure`.
class ConnectionStream {
 public:
  using executor_type = asio::io_context::executor_type;

  explicit ConnectionStream(Connection& connection) : connection_(connection) {}

  executor_type get_executor() { return context_.get_executor(); }

  template <class Buffers>
  std::size_t read_some(const Buffers& buffers, error_code& error) {
    std::size_t count = 0;
    for (const asio::mutable_buffer buffer : beast::buffers_range_ref(buffers)) {
      if (buffer.size() == 0) continue;
      note(connection_.read_some({static_cast<std::uint8_t*>(buffer.data()), buffer.size()}, count),
           error);
      if (!error && count == 0) error = asio::error::eof;
      break;
    }
    return count;
  }

  template <class Buffers>
  std::size_t write_some(const Buffers& buffers, error_code& error) {
    const std::string together = beast::buffers_to_string(buffers);
    note(connection_.write(as_bytes(together)), error);
    return error ? 0 : together.size();
  }

  // The concept names them; nobody calls them.
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers);
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers);

  friend void teardown(beast::role_type, ConnectionStream& stream, error_code&) {
    stream.connection_.close();
  }

  TransportStatus failure;

 private:
  void note(TransportStatus status, error_code& error) {
    error = status ? error_code(asio::error::connection_aborted) : error_code();
    failure = std::move(status);
  }

  asio::io_context context_;
  Connection& connection_;
};

// Whether that only says that nothing more came.
bool is_end(const error_code& error) {
  return error == asio::error::eof || error == websocket::error::closed ||
         error == beast::http::error::end_of_stream || error == beast::http::error::partial_message;
}

std::string stream_target(const HttpMesh& mesh) {
  std::string target = mesh.prefix + "/" + mesh.id + "/stream";
  if (!mesh.query.empty()) target.append("?").append(mesh.query);
  return target;
}

std::string url_of(const HttpMesh& mesh) {
  return (mesh.endpoint.is_secure ? "wss://" : "ws://") + mesh.endpoint.text() +
         stream_target(mesh);
}

TransportStatus refusal(const websocket::response_type& answer, const std::string& url) {
  HttpResponse response;
  response.status = answer.result_int();
  if (response.status == 401 || response.status == 403) return check_status(response, url);
  return TransportError{.error = runtime_error(url + ": no WebSocket, but HTTP status " +
                                               std::to_string(response.status)),
                        .wants_other_wire = true};
}

}  // namespace

struct WebSocketWire::Impl {
  Impl(const HttpMesh& mesh, const TransportOptions& options)
      : endpoint(mesh.endpoint),
        fields(with_token(options.token, options.http_fields)),
        target(stream_target(mesh)),
        url(url_of(mesh)),
        connection(options) {}

  // The second parameter: no compression.
  using Socket = websocket::stream<ConnectionStream&, false>;

  TransportStatus fail(const error_code& error) {
    connection.close();
    if (stream->failure) return std::exchange(stream->failure, std::nullopt);
    if (is_end(error)) {
      return retryable_error(
          runtime_error(endpoint.text() + ": the connection was closed before the end"));
    }
    return broken(error.message());
  }

  TransportStatus broken(const std::string& why) const {
    return TransportError{.error = runtime_error(url + ": not a valid WebSocket: " + why),
                          .wants_other_wire = true};
  }

  Endpoint endpoint;
  std::vector<HttpField> fields;
  std::string target;
  std::string url;
  Connection connection;
  std::optional<ConnectionStream> stream{};
  std::optional<Socket> socket{};  // on `stream`
};

WebSocketWire::WebSocketWire(const HttpMesh& mesh, const TransportOptions& options)
    : impl_(std::make_unique<Impl>(mesh, options)) {}

WebSocketWire::~WebSocketWire() = default;

std::string WebSocketWire::peer() const { return impl_->endpoint.text(); }
bool WebSocketWire::is_open() const { return impl_->connection.is_open(); }
void WebSocketWire::close() { impl_->connection.close(); }

TransportStatus WebSocketWire::connect() {
  Impl& impl = *impl_;
  if (auto failed = impl.connection.connect(impl.endpoint)) return failed;
  impl.socket.reset();
  impl.stream.emplace(impl.connection);
  Impl::Socket& socket = impl.socket.emplace(*impl.stream);
  socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(beast::http::field::user_agent, "pmesh");
    for (const HttpField& field : impl.fields) request.set(field.name, field.value);
  }));
  socket.read_message_max(kFrameHeaderBytes + kMaxFramePayload);
  socket.binary(true);
  socket.auto_fragment(false);
  websocket::response_type answer;
  error_code error;
  socket.handshake(answer, peer(), impl.target, error);
  if (!error) return std::nullopt;
  if (error != websocket::error::upgrade_declined) return impl.fail(error);
  impl.connection.close();
  return refusal(answer, impl.url);
}

TransportStatus WebSocketWire::send(std::span<const Bytes> frames) {
  for (const Bytes& frame : frames) {
    error_code error;
    impl_->socket->write(asio::buffer(frame), error);
    if (error) return impl_->fail(error);
  }
  return std::nullopt;
}

TransportStatus WebSocketWire::receive(std::span<std::uint8_t> buffer, std::size_t& count) {
  count = 0;
  while (count == 0) {  // an empty message is none
    error_code error;
    count = impl_->socket->read_some(asio::buffer(buffer.data(), buffer.size()), error);
    if (error) return impl_->fail(error);
    if (impl_->socket->got_text()) {
      close();
      return impl_->broken("a text message");
    }
  }
  return std::nullopt;
}

}  // namespace pmesh
