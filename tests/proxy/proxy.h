// A hostile network in a box: a TCP proxy on the loopback that is slow, late, and breaks what
// passes through it, all by one seed. For tests and benchmarks of clients.
//
//   SeededProxy proxy({.upstream_port = server_port, .is_http = true, .reset_probability = 0.5});
//   fetch("http://127.0.0.1:" + std::to_string(proxy.port()) + "/bunny");
//   proxy.counts().resets
//
// Every random choice about a connection comes from the seed and the connection's number. What
// depends on timing beside that: how bytes fall into segments, and so which of them are stalled.
//
// HTTP: the proxy reads requests and the heads of their answers, one after another (no pipelining;
// requests without bodies). After an answer 101 it passes bytes only. Bodies of unknown length end
// with the connection.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace pmesh::test {

/// Both directions of a link have the same delay and stalls, but each its own rate.
struct LinkOptions {
  std::uint64_t bits_per_second_down = 0;  ///< To the client; 0 is no limit.
  std::uint64_t bits_per_second_up = 0;    ///< To the upstream.
  std::chrono::microseconds delay{0};      ///< One way.
  std::size_t segment_bytes = 16 * 1024;   ///< Passed on at a time, at most.
  /// A segment that is lost and sent again: it and all behind it come so much later.
  double stall_probability = 0;
  std::chrono::microseconds stall{0};
};

struct ProxyOptions {
  std::uint16_t upstream_port = 0;  ///< On 127.0.0.1.
  std::uint16_t port = 0;           ///< To listen on, on 127.0.0.1; 0 is any free one.
  std::uint64_t seed = 1;
  LinkOptions link{};

  /// Connections that end with a RST, after 1 to `reset_bytes` bytes to the client.
  double reset_probability = 0;
  std::uint64_t reset_bytes = 64 * 1024;

  bool is_http = false;  ///< Else bytes are only passed, and the rest has no effect.
  /// Responses cut by a clean end of the connection, at any byte of the first `short_bytes` bytes
  /// of their body; those without a body, or with an unknown length, are not.
  double short_body_probability = 0;
  std::uint64_t short_bytes = 64 * 1024;
  /// Requests whose Range field is dropped: the answer is 200.
  double drop_range_probability = 0;
  /// Requests answered by 502 (and the end of the connection) without asking the upstream.
  double bad_gateway_probability = 0;
};

/// What a proxy has done so far.
struct ProxyCounts {
  std::uint64_t connections = 0;
  std::uint64_t resets = 0;
  std::uint64_t short_bodies = 0;
  std::uint64_t dropped_ranges = 0;
  std::uint64_t bad_gateways = 0;
  std::uint64_t stalls = 0;
  std::uint64_t bytes_down = 0;  ///< Handed to the client's side of the kernel, heads included.
  std::uint64_t bytes_up = 0;

  /// Connections broken under a transfer.
  std::uint64_t disconnects() const { return resets + short_bodies; }
};

/// One JSON object.
std::string to_json(const ProxyCounts& counts);

/// Threads: runs on a thread of its own; its members may be called on any.
class SeededProxy {
 public:
  /// Listens at once. Throws std::system_error if the port cannot be had.
  explicit SeededProxy(const ProxyOptions& options);
  ~SeededProxy();

  std::uint16_t port() const;
  ProxyCounts counts() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmesh::test
