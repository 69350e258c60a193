// Small servers on the loopback for the client's tests: each serves one PM file, and misbehaves as
// told. One thread, one connection at a time, blocking: the client's retries wait in the backlog.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "core/base/bytes.h"

namespace pmesh::test {

/// The descriptor of a connection to a server on the loopback.
int connect_to(std::uint16_t port);

/// The other end of a connection.
class Peer {
 public:
  explicit Peer(int descriptor) : descriptor_(descriptor) {}
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// What comes within ten seconds; nothing if the other end is gone.
  Bytes receive();
  /// Sends `bytes`; false if the other end is gone.
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

/// Passes bytes between `client` and a server on the loopback until one of them ends, or the server
/// has sent so many bytes.
void pass(Peer& client, std::uint16_t server_port, std::size_t allowed = SIZE_MAX);

/// Passes bytes between its clients and a server on the loopback, and cuts every connection after
/// so many bytes from the server.
class CuttingProxy {
 public:
  CuttingProxy(std::uint16_t server_port, std::function<std::size_t()> cut_after)
      : server_([=](Peer& client) { pass(client, server_port, cut_after()); }) {}
  std::uint16_t port() const { return server_.port(); }

 private:
  LoopbackServer server_;
};

/// How an HTTP host behaves; by default as a good one.
struct HttpBehaviour {
  bool ignores_ranges = false;               ///< Answers 200 with the whole file.
  int ignored_ranges = 0;                    ///< So many ranges after the first are ignored.
  bool has_chunks = true;                    ///< Else the chunks' routes are not found.
  bool keeps_alive = true;                   ///< Else it closes after every response.
  bool chunked = false;                      ///< Sends bodies in chunks, without a length.
  int failures = 0;                          ///< So many 503 first.
  std::function<std::size_t()> cut_after{};  ///< If set: bytes of a response until it is cut.
  int stalls = 0;                            ///< So many responses stop after half of their bytes.
  std::string raw_answer{};                  ///< If set: sent instead of any response.
  std::string extra_header{};                ///< A line, with its end.
  int upgrade_status = 404;                  ///< To /mesh/stream; 0 ends the connection.
  /// If set: takes the file's place when its hashed name has been asked for so often.
  Bytes replacement{};
  int requests_until_replaced = 0;
};

/// A web host with one file at /mesh.pmesh, which it serves as a pmesh server too: at /mesh, with
/// hashed file and chunks. Queries are ignored.
class HttpHost {
 public:
  HttpHost(Bytes file, HttpBehaviour behaviour);
  std::string url(const std::string& target = "/mesh.pmesh") const;
  std::uint16_t port() const { return server_.port(); }
  /// The Range headers of the requests so far, "" where there was none.
  const std::vector<std::string>& ranges() const { return ranges_; }
  /// The targets of the requests so far, and their whole heads.
  const std::vector<std::string>& targets() const { return targets_; }
  const std::vector<std::string>& requests() const { return requests_; }
  int connections() const { return server_.connections(); }

 private:
  void serve(Peer& peer);
  bool answer(Peer& peer, const std::string& request);
  std::string response_to(const std::string& request);
  std::string file_response(const Bytes& file, const std::string& range);
  void put(Bytes file);

  std::map<std::string, Bytes> files_;  // by target
  std::string hashed_target_;
  HttpBehaviour behaviour_;
  std::vector<std::string> ranges_;
  std::vector<std::string> targets_;
  std::vector<std::string> requests_;
  LoopbackServer server_;
};

}  // namespace pmesh::test
