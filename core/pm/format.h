// The PM file's header and index: the numbers, their layout in bytes, and their checks.
// docs/pm-format.md is the specification; this file is its mirror in code.
//
//   [header | index]  at most 16 KiB together: the prologue
//   [base mesh]       Draco
//   [chunk 0] ... [chunk n-1]   new components, if any, and vertex splits; any prefix that ends
//                     at a chunk is a valid LOD
//   [tail]            empty in version 0
//
// Threads: plain values; no shared state.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/lattice.h"

namespace pmesh {

inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'P', 'M', 'S', 'H', '\r', '\n', 0x1A};
inline constexpr std::uint16_t kFormatVersion = 0;
inline constexpr std::size_t kMaxHeaderBytes = 256;
inline constexpr std::size_t kMaxRowBytes = 64;
/// Header and index together; what a client reads blind.
inline constexpr std::size_t kMaxPrologueBytes = 16 * 1024;

/// Bounds between what a file claims and the bytes it brings, so that neither a small file can
/// claim much memory nor a few splits many bytes. The encoder keeps them.
inline constexpr std::uint64_t kMaxBaseFacesPerByte = 64;
inline constexpr std::uint64_t kMaxBaseBytesPerFace = 64;
inline constexpr std::uint64_t kMaxBaseBytesOverhead = 4096;
inline constexpr std::uint64_t kMaxSplitBytes = 64;
inline constexpr std::uint64_t kMaxRelocatingSplitBytes = 96;
inline constexpr std::uint64_t kMaxChunkOverhead = 64;

/// The first 16 bytes of SHA-256 over header and index, with this field zero.
using ContentHash = std::array<std::uint8_t, 16>;
/// Two lower-case hex digits a byte, as hashes have in URLs and ETags.
std::string to_hex(ByteView bytes);

/// The first 8 bytes of SHA-256 of a base mesh or chunk.
using SectionDigest = std::array<std::uint8_t, 8>;

struct MeshCounts {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  friend bool operator==(const MeshCounts&, const MeshCounts&) = default;
};

struct FileHeader {
  ContentHash content_hash{};
  std::uint64_t file_bytes = 0;
  std::uint64_t vertices = 0;  ///< At full resolution.
  std::uint64_t faces = 0;
  std::uint64_t base_vertices = 0;
  std::uint64_t base_faces = 0;
  std::uint64_t base_bytes = 0;
  std::uint32_t base_crc = 0;  ///< CRC-32C of the base's bytes.
  SectionDigest base_digest{};
  Lattice lattice;
  Vec3i box_low, box_high;       ///< The full mesh's bounding box on the lattice.
  bool has_borders = false;      ///< Border splits may occur.
  bool has_relocations = false;  ///< Splits may move the vertex that they keep.
  bool errors_measured = false;  ///< The rows' max_error and rms_error hold.
  bool has_arrivals = false;     ///< Chunks may begin with new components.
  std::string metric;            ///< Decimation metric by name, e.g. "melod".
  std::string parameters;        ///< Its parameters, e.g. "lambda=10".
  std::string unit;              ///< Unit of length, e.g. "m"; empty if not known.

  MeshCounts base_counts() const { return {base_vertices, base_faces}; }

  /// No split of this file takes more.
  std::uint64_t max_split_bytes() const {
    return has_relocations ? kMaxRelocatingSplitBytes : kMaxSplitBytes;
  }

  /// The diagonal of the full mesh's bounding box, in the mesh's units.
  double box_diagonal() const {
    const Vec3i size = box_high - box_low;
    return lattice.step * length(Vec3d{double(size.x), double(size.y), double(size.z)});
  }
};

/// One chunk, and the mesh after it.
struct ChunkRow {
  std::uint64_t offset = 0;  ///< From the file's start.
  std::uint32_t bytes = 0;
  std::uint32_t crc = 0;  ///< CRC-32C of the chunk's bytes.
  SectionDigest digest{};
  std::uint64_t vertices = 0;  ///< Of the LOD after this chunk.
  std::uint64_t faces = 0;
  double max_error = -1;  ///< Two-sided Hausdorff distance to the original; negative: not measured.
  double rms_error = -1;
  /// Of the new components that the chunk begins with; zeros if it has none.
  MeshCounts arrivals = {};

  std::uint64_t end() const { return offset + bytes; }
};

struct FileIndex {
  FileHeader header;
  std::vector<ChunkRow> chunks;      ///< Contiguous, in order; may be empty.
  std::uint32_t prologue_bytes = 0;  ///< Header and index; the base begins here.

  std::uint64_t base_end() const { return prologue_bytes + header.base_bytes; }
  /// Bytes of the shortest prefix that holds the base and the first `chunk_count` chunks.
  std::uint64_t prefix_bytes(std::size_t chunk_count) const {
    return chunk_count == 0 ? base_end() : chunks[chunk_count - 1].end();
  }
  /// Vertices and faces of the LOD after the base and the first `chunk_count` chunks.
  std::uint64_t vertices_after(std::size_t chunk_count) const {
    return chunk_count == 0 ? header.base_vertices : chunks[chunk_count - 1].vertices;
  }
  std::uint64_t faces_after(std::size_t chunk_count) const {
    return chunk_count == 0 ? header.base_faces : chunks[chunk_count - 1].faces;
  }
  /// What the splits of a chunk add: each one vertex, and two faces or, on a border, one.
  MeshCounts added_by_splits(std::size_t chunk) const {
    const ChunkRow& row = chunks[chunk];
    return {row.vertices - vertices_after(chunk) - row.arrivals.vertices,
            row.faces - faces_after(chunk) - row.arrivals.faces};
  }
};

/// What a decoder takes from a file at most. A file that claims more is refused
/// (out_of_resources) before any memory is taken for it. A decoded face costs about 50 bytes.
struct DecodeLimits {
  std::uint64_t max_faces = 400'000'000;
  std::uint64_t max_base_faces = 20'000'000;  ///< Of the base, and of a chunk's new components.
  /// Off only for fuzzing the parts behind the checksums.
  bool verify_checksums = true;
};

/// Header and index as bytes: fills in prologue_bytes, the rows' offsets, file_bytes and the
/// prologue's CRC, and rounds rms errors to what a row can hold (24 bits of precision), but takes
/// content_hash as it is. Precondition: the result fits
/// kMaxPrologueBytes, and the three strings fit kMaxHeaderBytes.
Bytes write_prologue(FileIndex& index);

/// Bytes that write_prologue will need for `index`.
std::size_t prologue_size(const FileIndex& index);

/// Where content_hash stands in the prologue; zero it to compute the hash.
inline constexpr std::size_t kContentHashOffset = 24;

/// Parses the prologue at the start of `prefix`. Nothing if `prefix` ends too early; an error if
/// no continuation of it can be a PM file: bad_input if it begins like none of a known version,
/// verification if it is damaged, out_of_resources if a limit is exceeded.
/// Checks magic, version, CRC, that sections are contiguous and add up, and that counts can be
/// held by the bytes that claim to hold them. Does not check content_hash (core/pm/digest.h does).
Result<std::optional<FileIndex>> parse_prologue(ByteView prefix, const DecodeLimits& limits = {});

}  // namespace pmesh
