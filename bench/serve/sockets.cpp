#include "bench/serve/sockets.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace pmesh::bench {
namespace {

constexpr std::uint32_t kLoopback = 0x7f000000;   // 127.0.0.0/8
constexpr std::uint32_t kAddresses = 0x00fffffe;  // the first and the last stay unused
constexpr std::uint32_t kStride = 40503;          // has no divisor in common with kAddresses
constexpr std::size_t kReadyAtOnce = 1024;

[[noreturn]] void fail(const char* what) {
  std::perror(what);
  std::exit(1);
}

sockaddr_in address(std::uint32_t host, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  result.sin_addr.s_addr = htonl(host);
  return result;
}

void set_flag(int socket, int level, int name) {
  const int on = 1;
  if (::setsockopt(socket, level, name, &on, sizeof on) != 0) fail("setsockopt");
}

}  // namespace

int connect_from(std::uint32_t source, std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) fail("socket");
  set_flag(socket, IPPROTO_IP, IP_BIND_ADDRESS_NO_PORT);
  set_flag(socket, IPPROTO_TCP, TCP_NODELAY);
  const std::uint64_t place = std::uint64_t{source} * kStride % kAddresses + 1;
  const sockaddr_in from = address(kLoopback + static_cast<std::uint32_t>(place), 0);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0) fail("bind");
  const sockaddr_in to = address(INADDR_LOOPBACK, port);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 &&
      errno != EINPROGRESS) {
    fail("connect");
  }
  return socket;
}

bool send_all(int socket, std::string_view bytes) {
  const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(bytes.size());
}

Poller::Poller() : descriptor_(::epoll_create1(EPOLL_CLOEXEC)), ready_(kReadyAtOnce) {
  if (descriptor_ < 0) fail("epoll_create1");
}

Poller::~Poller() { ::close(descriptor_); }

void Poller::add(int socket, std::uint32_t number, std::uint32_t events) {
  epoll_event event{.events = events, .data = {.u32 = number}};
  if (::epoll_ctl(descriptor_, EPOLL_CTL_ADD, socket, &event) != 0) fail("epoll_ctl");
}

void Poller::change(int socket, std::uint32_t number, std::uint32_t events) {
  epoll_event event{.events = events, .data = {.u32 = number}};
  if (::epoll_ctl(descriptor_, EPOLL_CTL_MOD, socket, &event) != 0) fail("epoll_ctl");
}

const std::vector<epoll_event>& Poller::wait(std::chrono::microseconds most) {
  ready_.resize(kReadyAtOnce);
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(most);
  const timespec limit{.tv_sec = whole.count(), .tv_nsec = 1000 * (most - whole).count()};
  const int count =
      ::epoll_pwait2(descriptor_, ready_.data(), static_cast<int>(kReadyAtOnce), &limit, nullptr);
  if (count < 0 && errno != EINTR) fail("epoll_pwait2");
  ready_.resize(static_cast<std::size_t>(std::max(count, 0)));
  return ready_;
}

}  // namespace pmesh::bench
