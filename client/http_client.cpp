#include "client/http_client.h"

#include <array>
#include <sstream>

#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/write.hpp>

namespace pmesh {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

namespace {

constexpr std::uint32_t kMaxHeadBytes = 64 * 1024;
constexpr std::size_t kBlockBytes = 64 * 1024;
// Received at a time before a response's head has been judged: its body may not be wanted.
constexpr std::size_t kHeadBlockBytes = 4 * 1024;

std::string request_text(const Endpoint& endpoint, const std::vector<HttpField>& fields,
                         const std::string& target, const std::optional<ByteSpan>& range) {
  http::request<http::empty_body> request{http::verb::get, target, 11};
  request.set(http::field::host, endpoint.text());
  request.set(http::field::user_agent, "pmesh");
  request.set(http::field::accept_encoding, "identity");
  for (const HttpField& field : fields) request.set(field.name, field.value);
  if (range) {
    request.set(http::field::range,
                "bytes=" + std::to_string(range->begin) + "-" + std::to_string(range->end - 1));
  }
  std::ostringstream text;
  text << request;
  return text.str();
}

}  // namespace

// One request and its response.
class HttpClient::Exchange {
 public:
  explicit Exchange(HttpClient& client) : client_(client) {
    parser_.header_limit(kMaxHeadBytes);
    parser_.body_limit(boost::none);
  }

  bool has_received() const { return has_received_; }

  TransportStatus send(const std::string& text) {
    return client_.connection_.write(as_bytes(text));
  }

  TransportStatus read_head(HttpResponse& response) {
    while (!parser_.is_header_done()) {
      if (TransportStatus failed = step()) return failed;
    }
    const auto& head = parser_.get();
    response.status = head.result_int();
    if (const auto length = parser_.content_length()) response.content_length = *length;
    parse_content_range(head[http::field::content_range], response);
    response.location = head[http::field::location];
    response.retry_after = parse_retry_after(head[http::field::retry_after]);
    const auto encoding = head[http::field::content_encoding];
    if (!encoding.empty() && encoding != "identity") {
      return failure("the host sends the file encoded (" + std::string(encoding) + ")", false);
    }
    return std::nullopt;
  }

  TransportStatus read_body(const BodyHandler& on_body) {
    std::array<std::uint8_t, kBlockBytes> block;
    while (!parser_.is_done()) {
      auto& body = parser_.get().body();
      body.data = block.data();
      body.size = block.size();
      if (TransportStatus failed = step()) return failed;
      const std::size_t count = block.size() - body.size;
      if (count > 0 && !on_body({block.data(), count})) break;
    }
    return std::nullopt;
  }

  bool can_be_reused() const { return parser_.is_done() && parser_.get().keep_alive(); }

 private:
  TransportError failure(const std::string& why, bool retryable) const {
    return {runtime_error(client_.endpoint_.text() + ": " + why), retryable};
  }

  // Parses what has come, or receives more if that is too little to go on.
  TransportStatus step() {
    if (buffer_.size() == 0) return receive();
    error_code error;
    buffer_.consume(parser_.put(buffer_.data(), error));
    if (error == http::error::need_more) return receive();
    if (error == http::error::need_buffer || !error) return std::nullopt;
    return failure("not a valid HTTP response: " + error.message(), false);
  }

  TransportStatus receive() {
    const auto space = buffer_.prepare(parser_.is_header_done() ? kBlockBytes : kHeadBlockBytes);
    std::size_t count = 0;
    TransportStatus failed = client_.connection_.read_some(
        {static_cast<std::uint8_t*>(space.data()), space.size()}, count);
    if (failed) return failed;
    buffer_.commit(count);
    if (count > 0) {
      has_received_ = true;
      return std::nullopt;
    }
    error_code error;
    if (parser_.got_some()) parser_.put_eof(error);
    if (parser_.is_done()) return std::nullopt;
    return failure("the connection was closed before the end of the response", true);
  }

  HttpClient& client_;
  http::response_parser<http::buffer_body> parser_;
  beast::flat_buffer buffer_;
  bool has_received_ = false;
};

HttpClient::HttpClient(Endpoint endpoint, const TransportOptions& options)
    : endpoint_(std::move(endpoint)),
      fields_(with_token(options.token, options.http_fields)),
      connection_(options) {}

TransportStatus HttpClient::get(const std::string& target, const std::optional<ByteSpan>& range,
                                const HeadHandler& on_head, const BodyHandler& on_body) {
  const bool reused = connection_.is_open();
  if (!reused) {
    if (TransportStatus failed = connection_.connect(endpoint_)) return failed;
  }
  Exchange exchange(*this);
  HttpResponse response;
  TransportStatus failed = exchange.send(request_text(endpoint_, fields_, target, range));
  if (!failed) failed = exchange.read_head(response);
  if (failed && failed->retryable && reused && !exchange.has_received()) {
    connection_.close();  // the host had closed the idle connection: a new one is no second try
    return get(target, range, on_head, on_body);
  }
  if (!failed) failed = on_head(response);
  if (!failed) failed = exchange.read_body(on_body);
  if (failed || !exchange.can_be_reused()) connection_.close();
  return failed;
}

std::string HttpClient::url_of(const std::string& target) const {
  return (endpoint_.is_secure ? "https://" : "http://") + endpoint_.text() + target;
}

}  // namespace pmesh
