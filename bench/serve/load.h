// What the load generator can do: hold connections, or ask for things. Each part prints one JSON
// object on standard output when it has ended.
#pragma once

#include <cstdint>
#include <string>

namespace pmesh::bench {

struct Target {
  std::uint16_t port = 0;
  std::uint32_t connections = 1;
  std::uint32_t addresses = 1;      ///< The connections come from so many, in turn.
  std::uint32_t first_address = 0;  ///< So that several processes share none.
  std::string path = "/health";
};

/// Connections that do no work.
struct HoldOptions {
  Target target;
  /// idle: gets one answer, then asks nothing. stall: asks for `path` and reads nothing. drip:
  /// sends a header that never ends, one field a second.
  enum class Kind { idle, stall, drip } kind = Kind::idle;
  double seconds = 30;  ///< At most, once all are open. Ends earlier if all have ended.
};

/// Holds them. Prints the line "open" once all are, then
/// {connections, refused, ended, resets, statuses: {status: number}, longest_seconds}: how many the
/// server ended, how many of those by a reset, the answers, and how long the one that was
/// ended last had been open. `refused` are those that were ended before all were open.
void hold(const HoldOptions& options);

/// Connections that ask for `path` again and again.
struct AskOptions {
  Target target;
  std::string range;        ///< The value of a Range field, if not empty.
  std::string expected;     ///< The body of every answer; empty: unknown.
  double rate = 0;          ///< Requests a second of all together; 0: as fast as answers come.
  double read_rate = 0;     ///< Bytes a second that each connection reads; 0: as they come.
  std::uint64_t times = 0;  ///< Requests of each connection; 0: until the time is up.
  double seconds = 10;
};

/// Asks. Prints {requests, errors, seconds, p50_ms, p99_ms, max_ms}: errors are connections that
/// were refused or ended, wrong bytes and statuses other than 200 and 206. Latency is that of whole
/// answers; at a given rate it counts from the time at which the request was due.
void ask(const AskOptions& options);

}  // namespace pmesh::bench
