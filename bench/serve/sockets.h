// Sockets of a load generator: non-blocking, on the loopback network, each from an address that the
// caller chooses, so that limits per address can stay as shipped. And what they wait by.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

#include <sys/epoll.h>

namespace pmesh::bench {

using Clock = std::chrono::steady_clock;

/// For Poller, whose events are unsigned.
inline constexpr std::uint32_t kReadable = EPOLLIN;

inline double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

/// Begins to connect to 127.0.0.1:`port` from the `source`th of the 2^24 - 2 addresses of
/// 127.0.0.0/8 that this program uses, which are spread all over. Ends the program if there are no
/// descriptors left.
int connect_from(std::uint32_t source, std::uint16_t port);

/// Sends all of it, which must be little beside what the kernel buffers; false if that failed.
bool send_all(int socket, std::string_view bytes);

/// The sockets waited for, each by its number.
class Poller {
 public:
  Poller();
  ~Poller();
  Poller(const Poller&) = delete;
  Poller& operator=(const Poller&) = delete;

  void add(int socket, std::uint32_t number, std::uint32_t events);
  void change(int socket, std::uint32_t number, std::uint32_t events);
  /// Waits for at most this long and gives (in `data.u32`) the numbers of those that are ready.
  const std::vector<epoll_event>& wait(std::chrono::microseconds most);

 private:
  int descriptor_;
  std::vector<epoll_event> ready_;
};

}  // namespace pmesh::bench
