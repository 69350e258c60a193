// A mesh that grows while its bytes come: transport -> verified prefix -> decoder -> refinable mesh
// -> observer. Goes on where it was after a cut connection, and downloads no more than the wish
// needs (apart from the 16 KiB read blind where nobody else knows the index).
//
// Threads: belongs to one thread at a time; the observers are called on that thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "client/backoff.h"
#include "client/transport.h"
#include "client/verified_prefix.h"
#include "core/pm/stream_decoder.h"
#include "protocol/lod_request.h"

namespace pmesh {

struct StreamProgress {
  std::uint64_t bytes_held = 0;
  std::uint64_t bytes_wanted = 0;  ///< Where the wish ends in the file; 0 while not known.
  std::uint64_t faces = 0;         ///< Of the finest LOD so far; 0 before the base.
};

/// What the user may do after a fetch that failed.
enum class Remedy : std::uint8_t {
  none,
  try_again,   ///< It was interrupted, or the connection failed: the same fetch may succeed later.
  start_over,  ///< The remote file is another than the one begun.
};

struct StreamOptions {
  std::string name;  ///< Of the remote, put before errors about the bytes it gave; may be empty.
  RetryPolicy retry;
  DecodeLimits limits;
  const CancelFlag* cancel = nullptr;  ///< May be null; the transport's own flag, as a rule.
  std::function<void(const StreamProgress&)> on_progress;  ///< May be empty.
  std::function<void(const Error&)> on_retry;              ///< Before each wait; may be empty.
};

class StreamingClient {
 public:
  /// `transport` must outlive the client.
  StreamingClient(Transport& transport, StreamOptions options);

  /// Starts from the whole sections of a partial PM file fetched earlier. Fails if `prefix` is
  /// none. Precondition: nothing has been fetched.
  Status resume_from(ByteView prefix);

  /// Fetches what `wish` needs and is not held yet; may be called again with a finer wish. The
  /// bytes of an unfinished section are kept over a cut; a section that does not match its digest
  /// is fetched once more. Fails with the transport's last error; as VerifiedPrefix::append() does,
  /// and with `verification` too if a section that matches its digest cannot be decoded; with
  /// `usage`, as soon as the index is known, if resolve() refuses the wish; with `runtime` if the
  /// remote file is another than the one begun. What came before the failure stays. If the remote
  /// holds only a part of the file, success means that part.
  Status fetch(const LodRequest& wish);

  /// Of the last fetch, if that has failed.
  Remedy remedy() const { return remedy_; }

  const VerifiedPrefix& prefix() const { return prefix_; }
  /// Precondition: prefix().has_base(), and the last call did not fail to decode.
  RefinableMesh& mesh() { return decoder_.mesh(); }
  bool has_mesh() const { return decoder_.has_base(); }
  /// File bytes received by all fetches, those received twice counted twice.
  std::uint64_t bytes_fetched() const { return bytes_fetched_; }

 private:
  TransportStatus attempt(const LodRequest& wish);
  TransportStatus open();
  TransportStatus confirm_same_file();
  TransportStatus read(const LodRequest& wish);
  bool accept(const LodRequest& wish, std::uint64_t offset, ByteView bytes);
  Status take(ByteView bytes);
  Status check_wish(const LodRequest& wish) const;
  Status check_hash(const ContentHash& remote);
  Error another_file(const std::string& how);
  TransportError bad_bytes(const Error& error) const;
  TransportError judge(const Error& error);
  std::optional<std::uint64_t> end_of(const LodRequest& wish) const;
  bool has_all_of(const LodRequest& wish) const;
  void report_progress(const LodRequest& wish) const;
  bool is_cancelled() const { return options_.cancel != nullptr && options_.cancel->load(); }
  bool wait(std::chrono::milliseconds delay) const;

  Transport& transport_;
  StreamOptions options_;
  bool is_open_ = false;
  VerifiedPrefix prefix_;
  StreamDecoder decoder_;
  std::uint64_t bytes_fetched_ = 0;
  Remedy remedy_ = Remedy::none;
  Status failure_;                           // of accept()
  bool is_section_bad_ = false;              // failure_ is a digest that does not match
  std::optional<std::uint64_t> second_try_;  // where the last section begins that had one
};

}  // namespace pmesh
