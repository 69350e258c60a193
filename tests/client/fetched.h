// A fetch that has been made, for tests of the transports.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "client/streaming_client.h"
#include "client/transport.h"
#include "tests/client/sample.h"

namespace pmesh::test {

/// Fetches a wish from `url`, without patience for silence.
struct Fetched {
  explicit Fetched(const std::string& url, const char* query = "")
      : transport(make_transport(*parse_mesh_url(url), transport_options())),
        client(*transport, stream_options()),
        status(client.fetch(wish(query))) {}

  static TransportOptions transport_options() {
    TransportOptions options;
    options.idle_timeout = std::chrono::milliseconds(300);
    return options;
  }
  static StreamOptions stream_options() {
    StreamOptions options;
    options.retry.first_delay = std::chrono::milliseconds(1);
    return options;
  }
  bool is_sample() const { return std::ranges::equal(client.prefix().verified(), sample_file()); }
  std::string error() const { return status.ok() ? "" : status.error().message; }

  std::unique_ptr<Transport> transport;
  StreamingClient client;
  Status status;
};

}  // namespace pmesh::test
