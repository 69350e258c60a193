// Mesh files in: PLY (ascii, little- and big-endian binary), OBJ, STL (ascii, binary) and OFF.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

enum class MeshFormat : std::uint8_t { ply, obj, stl, off };

/// The format that a file name's extension names (any case).
std::optional<MeshFormat> mesh_format_of(std::string_view path);

struct ImportedMesh {
  IndexedMesh mesh;
  /// The format stores every triangle's corners apart (STL): vertices are to be welded.
  bool is_soup = false;
  /// Faces of more than three corners; each was cut into a fan of triangles.
  std::uint64_t polygons = 0;
};

/// Parses a whole file's bytes. Positions are read in double precision, exactly as stored; all
/// other attributes are ignored. Errors (bad_input) name a line ("line 12: expected 3 numbers,
/// found 2") or, in binary files, an element or byte ("vertex 17: ..."); the caller puts the file's
/// name before them. An error if: the syntax is broken, the file ends early, a count is negative
/// or larger than the remaining bytes can hold, a coordinate is not finite, an index is out of
/// range, a face has fewer than three corners, there is no face. Memory: a small multiple of
/// `bytes`, whatever the counts claim. Threads: no shared state.
Result<ImportedMesh> parse_mesh(MeshFormat format, ByteView bytes);

/// Reads and parses the file at `path`; errors begin with the file's name.
Result<ImportedMesh> import_mesh(const std::string& path);

}  // namespace pmesh
