// HTTP/1.1 GET over one kept-alive connection, with ranges: as much HTTP as fetching a file needs.
// The one file of the client that knows Beast.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "client/connection.h"
#include "client/transport.h"
#include "protocol/byte_range.h"

namespace pmesh {

struct HttpResponse {
  unsigned status = 0;
  std::optional<std::uint64_t> content_length;  ///< Of the body that follows.
  std::optional<ByteSpan> content_range;        ///< Of a 206.
  std::optional<std::uint64_t> total_bytes;     ///< The file's, from Content-Range (206 and 416).
  std::string location;
};

class HttpClient {
 public:
  HttpClient(Endpoint endpoint, const TransportOptions& options);

  /// Judges a response by its head; a failure refuses the body.
  using HeadHandler = std::function<TransportStatus(const HttpResponse&)>;
  /// Takes the body in order; false ends the reading (and the connection, if bytes are left).
  using BodyHandler = std::function<bool(ByteView)>;

  /// Asks for `target`, the whole or a range of it (not empty). Fails if the connection is lost,
  /// also in the middle of the body, if the peer does not speak HTTP, or if it encodes the body (no
  /// encoding is accepted).
  TransportStatus get(const std::string& target, const std::optional<ByteSpan>& range,
                      const HeadHandler& on_head, const BodyHandler& on_body);

  /// Nothing for 200 and 206; else why `target` cannot be had, and whether to ask again.
  TransportStatus check_status(const HttpResponse& response, const std::string& target) const;

  void close() { connection_.close(); }
  std::string url_of(const std::string& target) const {
    return "http://" + endpoint_.text() + target;
  }

 private:
  class Exchange;

  Endpoint endpoint_;
  Connection connection_;
};

}  // namespace pmesh
