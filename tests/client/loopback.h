// Small servers on the loopback for the client's tests: each serves one PM file, and misbehaves as
// told. One thread, one connection at a time, blocking: the client's retries wait in the backlog.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/bytes.h"

namespace pmesh::test {

/// A connection that a server has accepted.
class Peer {
 public:
  explicit Peer(int descriptor) : descriptor_(descriptor) {}
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// What comes within ten seconds; nothing if the client is gone.
  Bytes receive();
  /// Sends `bytes`; false if the client is gone.
  bool send(ByteView bytes);
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Listens on a free port and hands every connection to `serve`, on a thread of its own, until
/// destroyed.
class LoopbackServer {
 public:
  explicit LoopbackServer(std::function<void(Peer&)> serve);
  ~LoopbackServer();

  std::uint16_t port() const { return port_; }
  int connections() const { return connections_; }

 private:
  void run();

  std::function<void(Peer&)> serve_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> stopping_{false};
  std::atomic<int> connections_{0};
  std::thread thread_;
};

/// Passes bytes between its clients and a server on the loopback, and cuts every connection after
/// so many bytes from the server.
class CuttingProxy {
 public:
  CuttingProxy(std::uint16_t server_port, std::function<std::size_t()> cut_after);
  std::uint16_t port() const { return server_.port(); }
  int connections() const { return server_.connections(); }

 private:
  void serve(Peer& client);

  std::uint16_t server_port_;
  std::function<std::size_t()> cut_after_;
  LoopbackServer server_;
};

/// How an HTTP host behaves; by default as a good one.
struct HttpBehaviour {
  bool ignores_ranges = false;               ///< Answers 200 with the whole file.
  bool keeps_alive = true;                   ///< Else it closes after every response.
  bool chunked = false;                      ///< Sends bodies in chunks, without a length.
  int failures = 0;                          ///< So many 503 first.
  std::function<std::size_t()> cut_after{};  ///< If set: bytes of a response until it is cut.
  int stalls = 0;                            ///< So many responses stop after half of their bytes.
  std::string raw_answer{};                  ///< If set: sent instead of any response.
  std::string extra_header{};                ///< A line, with its end.
};

/// A plain web host with one file at /mesh.pmesh.
class HttpHost {
 public:
  HttpHost(Bytes file, HttpBehaviour behaviour);
  std::string url() const;
  /// The Range headers of the requests so far, "" where there was none.
  const std::vector<std::string>& ranges() const { return ranges_; }
  int connections() const { return server_.connections(); }

 private:
  void serve(Peer& peer);
  bool answer(Peer& peer, const std::string& request);
  std::string response_to(const std::string& request);

  Bytes file_;
  HttpBehaviour behaviour_;
  std::vector<std::string> ranges_;
  LoopbackServer server_;
};

}  // namespace pmesh::test
