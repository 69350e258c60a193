// One fetch from a transport into one file: a mesh (core/io/export.h), or a PM file (.pmesh) that
// may be partial and that a later fetch continues.
#pragma once

#include <cstdint>
#include <string>

#include "client/streaming_client.h"
#include "client/transport.h"
#include "core/base/result.h"
#include "core/pm/format.h"
#include "protocol/lod_request.h"

namespace pmesh {

struct FetchJob {
  LodRequest wish;
  std::string output;  ///< Its extension says what is written; an existing mesh file is replaced.
  /// Start a .pmesh output over, whatever file is there; else a file there must be the beginning
  /// of the remote one and is continued, never shortened.
  bool force = false;
};

struct FetchReport {
  ContentHash hash{};
  std::uint64_t faces = 0;  ///< Of the mesh written, or of what the PM file written holds.
  std::uint64_t vertices = 0;
  std::uint64_t bytes_fetched = 0;  ///< File bytes received, those received twice counted twice.
  std::uint64_t bytes_total = 0;    ///< Of the whole PM file.
  bool reached = true;              ///< As in AppliedWish.
  bool complete = false;            ///< The whole PM file has been received.
};

/// Fails without a trace, but for one case: a .pmesh output whose fetch fails after some chunks is
/// written up to them if that is more than was there before (and the error says so, and whether to
/// run again or to start over), unless it fails because resolve() refuses the wish. Errors of the
/// output name it; the others are the streaming client's.
Result<FetchReport> fetch_to_file(Transport& transport, const FetchJob& job,
                                  const StreamOptions& options);

}  // namespace pmesh
