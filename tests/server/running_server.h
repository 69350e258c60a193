// A server on the loopback interface, and the plainest of clients: blocking sockets.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "server/server.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh::testing {

/// Serves a directory of its own over both protocols, on free ports, until destroyed.
class RunningServer {
 public:
  /// `adjust` may change the options; the addresses and the directory are set.
  explicit RunningServer(const std::function<void(ServerOptions&)>& adjust = {});
  ~RunningServer();

  Server& server() { return *server_; }
  const TemporaryDirectory& directory() const { return directory_; }
  /// Waits until run() has returned.
  void join() { thread_.join(); }

 private:
  TemporaryDirectory directory_;
  std::unique_ptr<Server> server_;
  std::thread thread_;
};

/// A connection to "127.0.0.1:PORT". What it receives is waited for up to ten seconds.
class TestClient {
 public:
  explicit TestClient(const std::string& address, int receive_buffer_bytes = 0);
  ~TestClient();
  TestClient(const TestClient&) = delete;
  TestClient& operator=(const TestClient&) = delete;

  void send(std::string_view bytes);
  /// Exactly `count` bytes; fewer if the connection ends.
  std::string receive(std::size_t count);
  /// All bytes up to and with `end`; all that came if the connection ends before.
  std::string receive_until(std::string_view end);
  /// All bytes up to the connection's end.
  std::string receive_all();
  /// Waits until the peer has ended the connection both ways or has reset it, for up to ten
  /// seconds; reads nothing meanwhile.
  void wait_for_end();
  /// True if the connection ended by a reset, as far as it was read.
  bool was_reset() const { return was_reset_; }

 private:
  std::string receive_some();

  int socket_;
  std::string held_;
  bool was_reset_ = false;
};

struct HttpResponse {
  int status = 0;
  std::string head;
  std::string body;

  std::string field(const std::string& name) const;
};

/// Reads one response; `has_body` is false for the answer to HEAD.
HttpResponse read_response(TestClient& client, bool has_body = true);

/// One request on a connection of its own.
HttpResponse fetch(const std::string& address, const std::string& target,
                   const std::string& fields = "");

/// "GET target" with a Host and these fields, each ended by CR LF.
std::string get_request(const std::string& target, const std::string& fields = "");

}  // namespace pmesh::testing
