#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "bench/serve/load.h"
#include "bench/serve/response.h"
#include "bench/serve/sockets.h"

namespace pmesh::bench {
namespace {

using Kind = HoldOptions::Kind;
using std::chrono::milliseconds;

constexpr std::size_t kOpeningAtOnce = 256;
constexpr auto kDripInterval = std::chrono::seconds(1);

struct Held {
  int socket = -1;
  Clock::time_point since{};
  Clock::time_point next_drip{};
  Response response{};
  bool ready = false;  // has come to where it is to be held
};

class Holder {
 public:
  explicit Holder(const HoldOptions& options) : options_(options), held_(count()) {
    const std::string start = "GET " + options.target.path + " HTTP/1.1\r\nHost: localhost\r\n";
    request_ = options.kind == Kind::drip ? start : start + "\r\n";
  }

  void run() {
    while (ready_ + ended_ < count()) {
      open_some();
      step();
    }
    refused_ = ended_;
    std::puts("open");
    std::fflush(stdout);
    const auto opened = Clock::now();
    while (ended_ < count() && seconds_since(opened) < options_.seconds) step();
    print();
  }

 private:
  std::uint32_t count() const { return options_.target.connections; }

  void open_some() {
    while (opened_ < count() && opened_ - ready_ - ended_ < kOpeningAtOnce) {
      const Target& target = options_.target;
      Held& held = held_[opened_];
      held.socket = connect_from(target.first_address + opened_ % target.addresses, target.port);
      held.since = Clock::now();
      poller_.add(held.socket, opened_, EPOLLOUT);
      ++opened_;
    }
  }

  void step() {
    for (const epoll_event& event : poller_.wait(milliseconds(20))) {
      Held& held = held_[event.data.u32];
      if (held.socket < 0) continue;
      if ((event.events & EPOLLIN) != 0) read(held);
      if (held.socket < 0) continue;
      if ((event.events & (EPOLLERR | EPOLLHUP | EPOLLRDHUP)) != 0) {
        end(held);
      } else if ((event.events & EPOLLOUT) != 0) {
        begin(held, event.data.u32);
      }
    }
    if (options_.kind == Kind::drip) drip();
  }

  /// Connected: sends the request, and from now on waits for the peer alone.
  void begin(Held& held, std::uint32_t number) {
    held.since = Clock::now();
    held.next_drip = held.since + kDripInterval;
    if (!send_all(held.socket, request_)) return end(held);
    const std::uint32_t reading = options_.kind == Kind::stall ? 0u : kReadable;
    poller_.change(held.socket, number, EPOLLRDHUP | reading);
    if (options_.kind != Kind::idle) set_ready(held);
  }

  void read(Held& held) {
    char bytes[4096];
    const ssize_t got = ::recv(held.socket, bytes, sizeof bytes, 0);
    if (got <= 0) return end(held);
    const auto step = held.response.feed({bytes, static_cast<std::size_t>(got)});
    if (step != Response::Step::done) return;
    ++statuses_[std::to_string(held.response.status())];
    held.response = Response();
    if (!held.ready) set_ready(held);
  }

  void drip() {
    const auto now = Clock::now();
    for (Held& held : held_) {
      if (held.socket < 0 || !held.ready || held.next_drip > now) continue;
      held.next_drip = now + kDripInterval;
      if (!send_all(held.socket, "X-Slow: 1\r\n")) end(held);
    }
  }

  void set_ready(Held& held) {
    held.ready = true;
    ++ready_;
  }

  void end(Held& held) {
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(held.socket, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error == ECONNRESET || error == EPIPE) ++resets_;
    ::close(held.socket);
    held.socket = -1;
    longest_ = std::max(longest_, seconds_since(held.since));
    if (held.ready) --ready_;
    ++ended_;
  }

  void print() const {
    const nlohmann::json result = {{"connections", count()}, {"refused", refused_},
                                   {"ended", ended_},        {"resets", resets_},
                                   {"statuses", statuses_},  {"longest_seconds", longest_}};
    std::puts(result.dump().c_str());
  }

  const HoldOptions& options_;
  std::string request_;
  Poller poller_;
  std::vector<Held> held_;
  std::uint32_t opened_ = 0;  // of held_, in order
  std::uint32_t ready_ = 0;
  std::uint32_t ended_ = 0;
  std::uint32_t refused_ = 0;
  std::uint32_t resets_ = 0;
  std::map<std::string, int> statuses_;
  double longest_ = 0;
};

}  // namespace

void hold(const HoldOptions& options) { Holder(options).run(); }

}  // namespace pmesh::bench
