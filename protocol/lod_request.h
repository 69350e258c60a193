// A wish for a level of detail, and the one pure function that maps it to bytes of a PM file.
// The HTTP query, the TCP message and the command line are three spellings of LodRequest.
//
// Threads: plain values and pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/result.h"
#include "core/pm/format.h"

namespace pmesh {

enum class WishKind : std::uint8_t {
  everything,  ///< The whole file.
  faces,       ///< The largest LOD with at most `count` faces.
  vertices,    ///< The largest LOD with at most `count` vertices.
  ratio,       ///< At most `ratio` times the full mesh's faces, rounded down; 0 < ratio <= 1.
  error,       ///< The first chunk end whose measured max_error is at most `error`.
  bytes,       ///< The largest whole-chunk prefix of at most `count` bytes.
  chunks,      ///< Chunks first_chunk to last_chunk; with chunk 0 all that stands before it.
};

struct LodRequest {
  WishKind kind = WishKind::everything;
  std::uint64_t count = 0;
  double ratio = 1;
  double error = 0;  ///< Finite, at least 0: in the mesh's units, unless error_is_percent.
  bool error_is_percent = false;  ///< `error` is in percent of FileHeader::box_diagonal().
  std::uint64_t first_chunk = 0;
  std::uint64_t last_chunk = 0;

  friend bool operator==(const LodRequest&, const LodRequest&) = default;
};

/// The error of a request that makes no sense.
inline Error usage_error(std::string message) { return {ErrorCode::usage, std::move(message)}; }

/// Parses a wish as spelled in an HTTP query without its '?': "" (everything), "faces=1000",
/// "vertices=500", "ratio=0.05", "error=0.25", "error=0.1%", "bytes=65536" or "chunks=0-3". Percent
/// escapes are the caller's business. Errors (usage) name what is wrong: an unknown key, two
/// wishes, a number out of range or with trailing characters.
Result<LodRequest> parse_wish(std::string_view query);

/// The spelling that parse_wish reads; "" for everything. parse_wish(to_query(w)) == w.
std::string to_query(const LodRequest& wish);

/// How many faces a ratio wish allows in the file of `index`.
std::uint64_t faces_of_ratio(double ratio, const FileIndex& index);

/// What a wish comes to in one file.
struct Resolution {
  /// First byte to send: 0, but the first chunk's for a chunks wish that leaves out chunk 0. So
  /// the wishes chunks=0-3 and chunks=4-9 give adjoining pieces of the file.
  std::uint64_t begin = 0;
  std::uint64_t end = 0;          ///< One past the last byte: always a chunk's (or the base's) end.
  std::uint64_t chunk_count = 0;  ///< Whole chunks from the file's start to `end`.
  /// Faces and vertices of the LOD wished for. Exact where the file has no border splits in the
  /// chunk that holds the LOD; else upper bounds (which splits add one face is known only inside
  /// the chunk), of which the one wished for is off by at most one face.
  std::uint64_t faces = 0;
  std::uint64_t vertices = 0;
  /// False if the base already exceeds the wish: the base is given. For an error wish, false if no
  /// chunk end is measured to be near enough: the whole file is given.
  bool reached = true;

  friend bool operator==(const Resolution&, const Resolution&) = default;
};

/// Fails (usage) only for a chunks wish beyond the file's chunks, and for an error wish if the
/// header says that no errors were measured. The base alone has no measured error, so it never
/// fulfils an error wish, not even as the full mesh of a file without chunks.
Result<Resolution> resolve(const LodRequest& wish, const FileIndex& index);

}  // namespace pmesh
