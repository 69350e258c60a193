// Mesh files out: PLY (binary little-endian), OBJ, GLB (core/io/glb_export.h) and Draco
// (core/io/draco_export.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/bytes.h"
#include "core/base/result.h"
#include "core/io/single_precision.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"

namespace pmesh {

enum class ExportFormat : std::uint8_t { ply, obj, glb, glb_draco, drc };

/// The format that a file name's extension names (any case): .ply, .obj, .glb or .drc.
std::optional<ExportFormat> export_format_of(std::string_view path);

/// The extensions, for messages.
inline constexpr std::string_view kExportExtensions = ".ply, .obj, .glb or .drc";

/// `mesh` as a file's bytes: the same bytes for the same mesh, lattice and format. Triangles and
/// vertices keep their order, but for Draco's. Positions are floats if those suffice
/// (fits_single_precision); else doubles, or in a GLB floats that its node puts in place. Fails
/// (runtime, out_of_resources) as the two headers above say; PLY and OBJ never do. Precondition:
/// `mesh` has a face. Throws std::bad_alloc for want of memory.
Result<Bytes> format_mesh(ExportFormat format, const LatticeMesh& mesh, const Lattice& lattice);

/// Writes format_mesh() to `path` (format by its extension) through core/files/atomic_file.h: on
/// any error the old file, if there was one, is still there.
Status export_mesh(const std::string& path, const LatticeMesh& mesh, const Lattice& lattice);

}  // namespace pmesh
