// TLS before a server of the tests: its certificate, made on the spot, and a relay that shows it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <openssl/ssl.h>

#include "tests/client/loopback.h"

namespace pmesh::test {

/// Listens on a free port, speaks TLS to its clients, and passes what is inside to a server on the
/// loopback. Its certificate is signed by itself and good for `name` alone ("localhost", or an
/// address).
class TlsFront {
 public:
  TlsFront(std::uint16_t server_port, const std::string& name);

  std::uint16_t port() const { return server_.port(); }
  /// The certificate as PEM, for those who trust it.
  const std::string& certificate() const { return certificate_; }

 private:
  void serve(Peer& client);

  std::uint16_t server_port_;
  std::string certificate_;
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_;
  LoopbackServer server_;
};

}  // namespace pmesh::test
