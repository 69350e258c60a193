// What the server counts about itself, for /metrics.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace pmesh {

/// N numbers that many threads add to: each thread mostly has a copy of its own, so that they do
/// not pull one cache line to and fro. Threads: all members may be called at the same time.
template <std::size_t N>
class SharedNumbers {
 public:
  void add(std::size_t i, std::uint64_t count) {
    copies_[copy_of_thread()].numbers[i].fetch_add(count, std::memory_order_relaxed);
  }
  std::uint64_t get(std::size_t i) const {
    std::uint64_t sum = 0;
    for (const Copy& copy : copies_) sum += copy.numbers[i].load(std::memory_order_relaxed);
    return sum;
  }

 private:
  static constexpr std::size_t kCopies = 8;
  struct alignas(64) Copy {
    std::array<std::atomic<std::uint64_t>, N> numbers{};
  };

  static std::size_t copy_of_thread() {
    static std::atomic<std::size_t> threads = 0;
    thread_local const std::size_t copy = threads.fetch_add(1) % kCopies;
    return copy;
  }

  std::array<Copy, kCopies> copies_;
};

/// Numbers of one kind, told apart by the enumerators of `Label`, which ends in `count_`. Threads:
/// as SharedNumbers.
template <class Label>
class Counters {
 public:
  static constexpr std::size_t kCount = static_cast<std::size_t>(Label::count_);

  void add(Label label, std::uint64_t count = 1) {
    numbers_.add(static_cast<std::size_t>(label), count);
  }
  void subtract(Label label) { numbers_.add(static_cast<std::size_t>(label), ~std::uint64_t{0}); }
  std::uint64_t get(Label label) const { return numbers_.get(static_cast<std::size_t>(label)); }

 private:
  SharedNumbers<kCount> numbers_;
};

enum class WireProtocol : std::uint8_t { http, frames, websocket, count_ };
inline constexpr std::array<std::string_view, 3> kWireProtocolNames{"http", "frames", "websocket"};

/// Whom a request was for.
enum class RouteName : std::uint8_t {
  other,
  viewer,
  catalog,
  info,
  file,
  chunk,
  lod,
  stream,
  health,
  metrics,
  openapi,
  count_
};
inline constexpr std::array<std::string_view, 11> kRouteNames{
    "other", "viewer", "catalog", "info",    "file",   "chunk",
    "lod",   "stream", "health",  "metrics", "openapi"};

/// Why a connection or request was turned away or cut: one for each limit and policy.
enum class LimitName : std::uint8_t {
  connections,              // more than max_connections
  connections_per_address,  // or requests, of a client behind a trusted proxy
  header_bytes,
  header_fields,
  target_bytes,
  ranges,
  header_timeout,
  idle_timeout,
  send_timeout,
  queued_bytes,  // reading stopped for a while
  streams,
  lod_queue,
  lod_per_address,
  lod_faces,
  access,
  count_
};
inline constexpr std::array<std::string_view, 15> kLimitNames{
    "connections",     "connections_per_address",
    "header_bytes",    "header_fields",
    "target_bytes",    "ranges",
    "header_timeout",  "idle_timeout",
    "send_timeout",    "queued_bytes",
    "streams",         "lod_queue",
    "lod_per_address", "lod_faces",
    "access"};

enum class ReloadResult : std::uint8_t { done, failed, count_ };
inline constexpr std::array<std::string_view, 2> kReloadResultNames{"done", "failed"};

/// Requests by route and status. A status that is not in the list counts as the first.
class RequestCounts {
 public:
  static constexpr std::array<int, 20> kStatuses{0,   101, 200, 204, 206, 304, 400, 401, 403, 404,
                                                 405, 408, 413, 414, 416, 426, 429, 431, 500, 503};

  void add(RouteName route, int status);
  std::uint64_t get(RouteName route, std::size_t status_index) const {
    return numbers_.get(static_cast<std::size_t>(route) * kStatuses.size() + status_index);
  }

 private:
  SharedNumbers<kStatuses.size() * kRouteNames.size()> numbers_;
};

/// How long requests took, from the last byte of their header to the last byte handed to the
/// kernel.
class DurationHistogram {
 public:
  /// Upper bounds, in seconds.
  static constexpr std::array<double, 9> kBounds{0.001, 0.005, 0.02, 0.1, 0.5, 2, 10, 60, 600};

  void add(std::chrono::steady_clock::duration duration);
  /// How many lasted up to kBounds[i]; for i = kBounds.size() all.
  std::uint64_t count_up_to(std::size_t i) const;
  double seconds() const { return static_cast<double>(numbers_.get(kMicroseconds)) * 1e-6; }

 private:
  static constexpr std::size_t kMicroseconds = kBounds.size() + 1;

  SharedNumbers<kMicroseconds + 1> numbers_;  // of the buckets, not cumulated; and the sum
};

/// Threads: all members of all members may be called at the same time.
struct Metrics {
  const std::chrono::system_clock::time_point started = std::chrono::system_clock::now();
  Counters<WireProtocol> accepted;
  Counters<WireProtocol> open;  ///< Now.
  Counters<WireProtocol> sent_bytes;
  RequestCounts requests;
  DurationHistogram durations;
  Counters<LimitName> limits;
  Counters<ReloadResult> reloads;
  std::atomic<std::uint64_t> broken_files = 0;  ///< Transfers cut because the file was written to.
};

}  // namespace pmesh
