// A fetch that has been made, for tests of the transports.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "client/streaming_client.h"
#include "client/transport.h"
#include "tests/client/sample.h"

namespace pmesh::test {

/// Far longer than an answer on the loopback takes, even on a busy machine.
inline constexpr std::chrono::milliseconds kImpatient{1000};

/// Fetches a wish from `url`.
struct Fetched {
  explicit Fetched(const std::string& url, const char* query = "",
                   const TransportOptions& options = {.idle_timeout = std::chrono::seconds(20)})
      : transport(make_transport(*parse_mesh_url(url), options)),
        client(*transport, noting(stream_options())),
        status(client.fetch(wish(query))) {}

  static StreamOptions stream_options() {
    StreamOptions options;
    options.retry.first_delay = std::chrono::milliseconds(1);
    return options;
  }
  StreamOptions noting(StreamOptions options) {
    options.on_retry = [this](const Error& error) { retries.push_back(error.message); };
    return options;
  }
  bool is_sample() const { return std::ranges::equal(client.prefix().verified(), sample_file()); }
  std::string error() const { return status.ok() ? "" : status.error().message; }

  std::vector<std::string> retries;  ///< What on_retry was told.
  std::unique_ptr<Transport> transport;
  StreamingClient client;
  Status status;
};

}  // namespace pmesh::test
