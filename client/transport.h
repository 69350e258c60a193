// The one interface through which a PM file's bytes come: over HTTP, WebSocket or TCP, or from a
// disk. A transport knows addresses and wires, but nothing of meshes.
//
// Threads: a transport belongs to one thread at a time; only CancelFlag may be set from another
// thread or a signal handler.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/http_field.h"
#include "client/mesh_url.h"
#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/pm/format.h"
#include "protocol/lod_request.h"

namespace pmesh {

/// Set to true to make a fetch stop soon (within about 0.1 s) with what it has.
using CancelFlag = std::atomic<bool>;

struct TransportOptions {
  std::chrono::milliseconds connect_timeout{10'000};
  /// How long a peer may stay silent, or take no bytes, before the connection counts as lost.
  std::chrono::milliseconds idle_timeout{30'000};
  const CancelFlag* cancel = nullptr;  ///< May be null; must outlive the transport.
  std::string token{};  ///< Shown to the server, as parse_token() gives it; may be empty.
  /// Sent with every HTTP and WebSocket request.
  std::vector<HttpField> http_fields{};
  /// For TLS: a PEM file of the authorities to trust instead of the system's; may be empty.
  std::string ca_file{};
};

/// Why a transport failed. Retryable: lost or refused connection, timeout, HTTP 408, 429 or 5xx.
/// Final: asking again cannot help (404, a broken protocol, cancelled).
struct TransportError {
  Error error;
  bool retryable = false;
  /// After how long the peer asks to come again, if it does.
  std::optional<std::chrono::milliseconds> retry_after{};
  /// The host is there, but does not offer this wire: another may do.
  bool wants_other_wire = false;
};
inline TransportError final_error(Error error) { return {.error = std::move(error)}; }
inline TransportError retryable_error(Error error) {
  return {.error = std::move(error), .retryable = true};
}

/// Nothing is success.
using TransportStatus = std::optional<TransportError>;

/// What is known of the remote file before its bytes.
struct RemoteFile {
  std::optional<ContentHash> hash;
  /// How many bytes the peer can give: less than the file has if it holds only a prefix.
  std::optional<std::uint64_t> available_bytes;
};

/// Takes file bytes that begin at `offset`; gives false to end the reading.
using ByteSink = std::function<bool(std::uint64_t offset, ByteView bytes)>;

struct ReadRequest {
  std::uint64_t from = 0;
  /// One past the last byte wanted. If not known yet (the index has not been read), the transport
  /// gives what covers `wish`, if its peer can resolve that, or else the first 16 KiB.
  std::optional<std::uint64_t> end;
  LodRequest wish;
  /// Of the file, once it is known: for hosts that give out chunks but no ranges. May be null.
  const FileIndex* index = nullptr;
};

class Transport {
 public:
  virtual ~Transport() = default;

  /// Connects and asks for the file. Called again after a failure, it connects anew.
  virtual TransportStatus open() = 0;

  /// Gives bytes to `sink` in order, without gaps, until the request is met, the sink says false
  /// or the file ends. The first byte given may lie before `from` (a host that ignores ranges
  /// starts at 0), never behind it; bytes past `end` may come too. May give fewer than asked.
  /// Precondition: the last open() succeeded, and no read has failed since.
  virtual TransportStatus read(const ReadRequest& request, const ByteSink& sink) = 0;

  /// What is known so far: after open(), more after read().
  virtual const RemoteFile& remote() const { return remote_; }

 protected:
  RemoteFile remote_;
};

/// The transport that `url` needs; connects only in open().
std::unique_ptr<Transport> make_transport(const MeshUrl& url, const TransportOptions& options);

}  // namespace pmesh
