// TLS by OpenSSL on a non-blocking socket: nothing is buffered for a connection but the record that
// OpenSSL works on, and that only while it does.
#pragma once

#include <memory>
#include <span>
#include <string>

#include <openssl/ssl.h>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "server/net/wire_step.h"
#include "server/options.h"

namespace pmesh {

/// A certificate and its key, ready to serve TLS 1.2 and 1.3. Threads: immutable.
class TlsContext {
 public:
  /// Fails (usage) if a file cannot be read, is no PEM, or the key is not the certificate's.
  static Result<std::shared_ptr<const TlsContext>> load(const TlsOptions& options);

  SSL_CTX* get() const { return context_.get(); }

 private:
  struct Free {
    void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
  };

  TlsContext() = default;

  std::unique_ptr<SSL_CTX, Free> context_;
};

/// One connection's TLS. Threads: one at a time.
class TlsStream {
 public:
  /// The largest record, and so the most that one write() takes.
  static constexpr std::size_t kRecordBytes = 16 * 1024;

  /// Speaks over `socket`, which stays the caller's. Throws std::bad_alloc.
  TlsStream(const TlsContext& context, int socket);

  /// Goes on with the handshake; `moved` once it is over.
  WireStep handshake();

  /// Precondition: a buffer that is not empty.
  WireStep read(std::span<char> into);

  /// After must_read or must_write the next write() must be of the same bytes, which may stand
  /// elsewhere in memory. Precondition: not empty.
  WireStep write(ByteView bytes);

  /// Tells the peer that nothing more will come, if that can be said at once.
  void say_goodbye();

 private:
  struct Free {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };

  WireStep step(int result, std::size_t count);

  std::unique_ptr<SSL, Free> ssl_;
  bool is_broken_ = false;
};

}  // namespace pmesh
