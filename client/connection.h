// A TCP connection, with TLS if its endpoint says so, and with deadlines: every call returns within
// its timeout, and soon after the cancel flag is set (but a host name's look-up, once begun, ends
// when the system ends it). The one file of the client that knows Asio; blocking on the outside.
//
// With TLS the peer must show a certificate for the endpoint's host, signed by an authority that
// the system trusts or, instead, by one in the file that the options name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "client/transport.h"

namespace pmesh {

class Connection {
 public:
  explicit Connection(const TransportOptions& options);
  ~Connection();

  /// Resolves the host and connects to the first of its addresses that answers; an earlier
  /// connection is closed. Errors name the endpoint. Retryable but for a cancel, a certificate that
  /// is not to be trusted, and a file of authorities that cannot be read (usage).
  TransportStatus connect(const Endpoint& endpoint);
  bool is_open() const;
  void close();

  /// Precondition of both: is_open(). They close the connection when they fail.
  TransportStatus write(ByteView bytes);
  /// Reads at least one byte into `buffer`; `count` is how many, 0 if the peer has ended the
  /// stream.
  TransportStatus read_some(std::span<std::uint8_t> buffer, std::size_t& count);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pmesh
