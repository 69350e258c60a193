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

/// Far longer than an answer on the loopback takes, even on a busy machine.
inline constexpr std::chrono::milliseconds kImpatient{1000};

/// Fetches a wish from `url`; a server's silence counts as a lost connection after `idle_timeout`.
struct Fetched {
  explicit Fetched(const std::string& url, const char* query = "",
                   std::chrono::milliseconds idle_timeout = std::chrono::seconds(20))
      : transport(make_transport(*parse_mesh_url(url), {.idle_timeout = idle_timeout})),
        client(*transport, stream_options()),
        status(client.fetch(wish(query))) {}

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
