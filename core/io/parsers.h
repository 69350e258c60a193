// The parser of each mesh format, behind parse_mesh() of import.h, whose contract they share.
// They may give a mesh without faces: parse_mesh() refuses it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/io/import.h"

namespace pmesh {

Result<ImportedMesh> parse_ply(ByteView bytes);
Result<ImportedMesh> parse_obj(ByteView bytes);
Result<ImportedMesh> parse_stl(ByteView bytes);
Result<ImportedMesh> parse_off(ByteView bytes);

/// Adds a face as a fan from its first corner. Fails, without a location, if there are fewer than
/// three corners.
Status append_polygon(ImportedMesh& out, std::span<const std::uint32_t> corners);

/// Whether bytes after the declared data hold nothing: blanks, line ends, zeros.
bool is_padding(ByteView bytes);

/// "vertex index 9 is out of range: the mesh has 8 vertices".
std::string index_out_of_range(std::int64_t index, std::uint64_t vertices);

}  // namespace pmesh
