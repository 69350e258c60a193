#include <algorithm>
#include <cstdio>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "bench/serve/load.h"
#include "bench/serve/response.h"
#include "bench/serve/sockets.h"

namespace pmesh::bench {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::microseconds;

constexpr std::size_t kReadBytes = 64 * 1024;
constexpr microseconds kTick{10'000};  // how often a connection with a read rate is looked at

Clock::duration time_of(double seconds) {
  return duration_cast<Clock::duration>(duration<double>(seconds));
}

struct Client {
  int socket = -1;
  bool connected = false;
  bool asking = false;             // a request is under way
  Clock::time_point due{};         // of this request, or of the next
  Clock::time_point free_since{};  // the end of the answer before
  Clock::time_point read_again{};
  Response response{};
  std::uint64_t answered = 0;
};

class Asker {
 public:
  explicit Asker(const AskOptions& options)
      : options_(options), clients_(options.target.connections), buffer_(kReadBytes, '\0') {
    request_ = "GET " + options.target.path + " HTTP/1.1\r\nHost: localhost\r\n";
    if (!options.range.empty()) request_ += "Range: bytes=" + options.range + "\r\n";
    request_ += "\r\n";
    if (options.rate > 0) interval_ = time_of(double(clients_.size()) / options.rate);
  }

  void run() {
    for (std::uint32_t i = 0; i < clients_.size(); ++i) open(i);
    const auto started = Clock::now();
    while (open_ > 0 && seconds_since(started) < options_.seconds) step();
    if (options_.times > 0) errors_ += open_;  // did not get all in time
    print(seconds_since(started));
  }

 private:
  void open(std::uint32_t number) {
    Client& client = clients_[number];
    const Target& target = options_.target;
    client.socket = connect_from(target.first_address + number % target.addresses, target.port);
    client.due = Clock::now() + interval_ * number / static_cast<int>(clients_.size());
    poller_.add(client.socket, number, EPOLLOUT);
    ++open_;
  }

  void step() {
    for (const epoll_event& event : poller_.wait(patience())) {
      Client& client = clients_[event.data.u32];
      if (!client.connected) {
        client.connected = true;
        // With a read rate the client is looked at every tick instead.
        poller_.change(client.socket, event.data.u32, options_.read_rate > 0 ? 0u : kReadable);
      } else if (client.socket >= 0) {
        read(client);
      }
    }
    const auto now = Clock::now();
    for (Client& client : clients_) {
      if (client.socket < 0 || !client.connected) continue;
      if (!client.asking && client.due <= now) send(client);
      if (client.asking && options_.read_rate > 0 && client.read_again <= now) read(client);
    }
  }

  /// Until the next request is due, or the next tick.
  microseconds patience() const {
    if (options_.read_rate > 0) return kTick;
    auto next = Clock::now() + kTick;
    for (const Client& client : clients_) {
      if (client.socket >= 0 && client.connected && !client.asking) {
        next = std::min(next, client.due);
      }
    }
    return std::max(duration_cast<microseconds>(next - Clock::now()), microseconds(0));
  }

  void send(Client& client) {
    const auto now = Clock::now();
    // A request that waits for the answer before it is late by the server's doing.
    if (interval_ == interval_.zero() || client.free_since <= client.due) client.due = now;
    client.read_again = now;
    client.asking = true;
    client.response = Response(options_.expected);
    if (!send_all(client.socket, request_)) fail(client);
  }

  void read(Client& client) {
    const ssize_t got = ::recv(client.socket, buffer_.data(), buffer_.size(), 0);
    if (got < 0 && errno == EAGAIN) return;
    if (got <= 0 || !client.asking) return fail(client);
    if (options_.read_rate > 0) client.read_again += time_of(double(got) / options_.read_rate);
    const auto step =
        client.response.feed(std::string_view(buffer_).substr(0, static_cast<std::size_t>(got)));
    if (step == Response::Step::bad) return fail(client);
    if (step == Response::Step::done) finish(client);
  }

  void finish(Client& client) {
    const auto now = Clock::now();
    latencies_.push_back(duration<double, std::milli>(now - client.due).count());
    const int status = client.response.status();
    if (status != 200 && status != 206) ++errors_;
    client.asking = false;
    client.free_since = now;
    client.due = interval_ == interval_.zero() ? now : client.due + interval_;
    if (++client.answered == options_.times) close(client);
  }

  void fail(Client& client) {
    ++errors_;
    close(client);
  }

  void close(Client& client) {
    ::close(client.socket);
    client.socket = -1;
    --open_;
  }

  double percentile(double share) const {
    if (latencies_.empty()) return 0;
    return latencies_[static_cast<std::size_t>(share * double(latencies_.size() - 1))];
  }

  void print(double seconds) {
    std::ranges::sort(latencies_);
    const nlohmann::json result = {
        {"requests", latencies_.size()}, {"errors", errors_},          {"seconds", seconds},
        {"p50_ms", percentile(0.5)},     {"p99_ms", percentile(0.99)}, {"max_ms", percentile(1)}};
    std::puts(result.dump().c_str());
  }

  const AskOptions& options_;
  std::string request_;
  Clock::duration interval_{};
  Poller poller_;
  std::vector<Client> clients_;
  std::uint32_t open_ = 0;
  std::uint64_t errors_ = 0;
  std::vector<double> latencies_;
  std::string buffer_;
};

}  // namespace

void ask(const AskOptions& options) { Asker(options).run(); }

}  // namespace pmesh::bench
