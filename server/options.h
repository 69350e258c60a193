// How the server is set up. Every limit has a default that is safe on the open internet.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace pmesh {

/// What one connection may take and how long it may take it.
struct SessionLimits {
  std::size_t header_bytes = 16 * 1024;  ///< Of an HTTP request: request line and fields.
  std::size_t header_fields = 100;
  /// From a request's first byte to its header's end; also for the hello of the TCP protocol.
  std::chrono::milliseconds header_timeout{10'000};
  /// Between requests, or between frames while nothing is being sent.
  std::chrono::milliseconds idle_timeout{60'000};
  /// Without the peer taking a byte of what is sent to it; then the connection is reset.
  std::chrono::milliseconds send_timeout{30'000};
  /// Bytes that the kernel buffers for a peer (SO_SNDBUF): a thousand stalled readers must not
  /// fill its memory.
  int send_buffer_bytes = 256 * 1024;
  /// Answers of the TCP protocol that wait to be sent, in bytes; at the bound reading stops.
  std::size_t queued_bytes = 64 * 1024;
};

struct ServerOptions {
  std::string directory;                ///< Of the PM files, with all that lies below it.
  std::string http = "127.0.0.1:8080";  ///< "ADDRESS:PORT"; port 0 is any free one; empty: none.
  std::string tcp;                      ///< The same for the TCP protocol.
  unsigned threads = 0;                 ///< 0: as many as the machine has cores.
  std::size_t max_connections = 10'000;
  /// How long transfers may go on after drain().
  std::chrono::milliseconds drain_grace{30'000};
  SessionLimits limits;
};

}  // namespace pmesh
