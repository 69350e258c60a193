// How the server is set up. Every limit has a default that is safe on the open internet.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pmesh {

/// What one connection may take and how long it may take it.
struct SessionLimits {
  std::size_t header_bytes = 16 * 1024;  ///< Of an HTTP request: request line and fields.
  std::size_t header_fields = 100;
  std::size_t target_bytes = 8192;  ///< Of an HTTP request's target.
  /// Ranges in one Range field. One range is honoured, more are ignored (the answer is the whole),
  /// more than this are refused.
  std::size_t ranges = 8;
  /// From a request's first byte to its header's end; from accepting a connection to the first
  /// byte; also for TLS handshakes, PROXY headers and the hello of the frame protocol.
  std::chrono::milliseconds header_timeout{8'000};
  /// Between requests, or between frames while nothing is being sent.
  std::chrono::milliseconds idle_timeout{60'000};
  /// Without the peer taking a byte of what is sent to it; then the connection is reset.
  std::chrono::milliseconds send_timeout{30'000};
  /// Bytes that the kernel buffers for a peer (SO_SNDBUF): a thousand stalled readers must not
  /// fill its memory.
  int send_buffer_bytes = 192 * 1024;
  /// The same for a peer that has just made room by reading: a large buffer spares wake-ups.
  int live_send_buffer_bytes = 1024 * 1024;
  /// Answers of the frame protocol that wait to be sent, in bytes; at the bound reading stops.
  std::size_t queued_bytes = 64 * 1024;
  /// Meshes open at once on one connection of the frame protocol.
  std::size_t streams = 16;
};

/// Finished levels of detail (`/{id}/lod.glb` and the like), which cost memory and time.
struct LodLimits {
  unsigned workers = 1;             ///< Threads that make them.
  std::size_t queue = 64;           ///< Waiting for a worker; more are answered by 503.
  std::size_t per_address = 8;      ///< Waiting or being made for one client; 0: any number.
  std::uint64_t faces = 5'000'000;  ///< Of one of them; a wish for more is refused.
  std::size_t cache_bytes = 256 * 1024 * 1024;
};

/// Who may read the meshes. Both empty: everybody.
struct AccessOptions {
  std::vector<std::string> tokens;  ///< `Authorization: Bearer` gives access to everything.
  std::string url_key;  ///< Signs URLs (server/access/signed_query.h) for one mesh and some time.
};

/// PEM files; TLS is served if both are set.
struct TlsOptions {
  std::string certificate;  ///< With the chain behind it.
  std::string key;
};

struct ServerOptions {
  std::string directory;                ///< Of the PM files, with all that lies below it.
  std::string http = "127.0.0.1:8080";  ///< "ADDRESS:PORT"; port 0 is any free one; empty: none.
  std::string tcp;                      ///< The same for the frame protocol.
  std::string metrics;                  ///< The same for /metrics alone; empty: served with HTTP.
  unsigned threads = 0;                 ///< 0: as many as the machine has cores.
  std::size_t max_connections = 12'000;
  std::size_t max_connections_per_address = 256;  ///< An IPv6 address counts by its /64; 0: any.
  /// CIDR blocks of proxies, whose X-Forwarded-For and PROXY headers are believed.
  std::vector<std::string> trusted_proxies;
  bool access_log = false;  ///< A line in the log for every HTTP answer and every want.
  /// How long transfers may go on after drain().
  std::chrono::milliseconds drain_grace{30'000};
  SessionLimits limits;
  LodLimits lod;
  AccessOptions access;
  TlsOptions tls;
};

}  // namespace pmesh
