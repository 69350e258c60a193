// HTTP/1.1 GET over one kept-alive connection, with ranges: as much HTTP as fetching a file needs.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "client/connection.h"
#include "client/http_status.h"
#include "client/transport.h"
#include "protocol/byte_range.h"

namespace pmesh {

class HttpClient {
 public:
  HttpClient(Endpoint endpoint, const TransportOptions& options);

  /// Judges a response by its head; a failure refuses the body.
  using HeadHandler = std::function<TransportStatus(const HttpResponse&)>;
  /// Takes the body in order, as it comes; false ends the reading (and the connection, if bytes are
  /// left).
  using BodyHandler = std::function<bool(ByteView)>;

  /// Asks for `target`, the whole or a range of it (not empty). Fails if the connection is lost,
  /// also in the middle of the body, if the peer does not speak HTTP, or if it encodes the body (no
  /// encoding is accepted). A body that nobody wants is not read on: at most 4 KiB of it have come.
  TransportStatus get(const std::string& target, const std::optional<ByteSpan>& range,
                      const HeadHandler& on_head, const BodyHandler& on_body);

  void close() { connection_.close(); }
  std::string url_of(const std::string& target) const;

 private:
  class Exchange;

  Endpoint endpoint_;
  std::vector<HttpField> fields_;
  Connection connection_;
};

}  // namespace pmesh
