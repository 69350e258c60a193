// The server: serves the PM files of a directory over HTTP and the TCP protocol of
// docs/protocol.md.
//
//   auto server = Server::open({.directory = "meshes"});
//   if (!server) return report(server.error());
//   (*server)->run();
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/base/result.h"
#include "server/options.h"

namespace pmesh {

/// Threads: drain(), stop() and reload() may be called on any thread at any time, the rest as said.
class Server {
 public:
  /// Opens the meshes and binds the addresses. Fails (usage) on a directory, address, block of
  /// proxies or certificate that makes no sense, (runtime) on an address that cannot be bound,
  /// (out_of_resources) if there are not enough descriptors. The process ignores SIGPIPE from now
  /// on: sendfile(2) cannot be told not to raise it.
  static Result<std::unique_ptr<Server>> open(const ServerOptions& options);
  ~Server();

  /// "ADDRESS:PORT" as bound; empty for what is not served.
  const std::string& http_address() const { return http_address_; }
  const std::string& tcp_address() const { return tcp_address_; }
  const std::string& metrics_address() const { return metrics_address_; }

  /// What the configuration is now.
  using Reload = std::function<Result<ServerOptions>()>;
  /// From now on SIGTERM and SIGINT drain, and a second one stops at once; SIGHUP reloads, if
  /// `reload` is not empty. Before run(). `reload` is called on a thread that serves.
  void handle_signals(Reload reload = {});

  /// Takes over limits, access and TLS from `options`: for new connections, and access for the next
  /// request of old ones. Fails as open() does, and then nothing has changed. On any thread.
  Status reload(const ServerOptions& options);

  /// Serves until drained or stopped. Once only; uses the calling thread and options.threads - 1
  /// more.
  void run();

  /// Accepts no more connections, lets the transfers under way end, cuts those that have not after
  /// options.drain_grace; then run() returns.
  void drain();

  /// Cuts everything; run() returns.
  void stop();

 private:
  class Impl;
  explicit Server(std::unique_ptr<Impl> impl);

  Status listen(const ServerOptions& options);

  std::unique_ptr<Impl> impl_;
  std::string http_address_;
  std::string tcp_address_;
  std::string metrics_address_;
};

}  // namespace pmesh
