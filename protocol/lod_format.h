// The file formats of finished levels of detail, `/{id}/lod.{ending}`.
//
// Threads: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace pmesh {

enum class LodFormat : std::uint8_t {
  glb,        ///< Binary glTF 2.0 with plain accessors.
  glb_draco,  ///< The same with KHR_draco_mesh_compression.
  ply,
  obj,
  drc,  ///< Draco.
};

/// The format of the ending "glb", "ply", "obj" or "drc"; nothing for any other. `draco` asks for a
/// compressed GLB and means nothing to the other formats.
std::optional<LodFormat> lod_format_of(std::string_view ending, bool draco = false);

/// "glb", "ply", "obj" or "drc".
std::string_view file_ending(LodFormat format);

/// A name for each of the five, as entity tags have it: the ending, but "glb-draco".
std::string_view format_name(LodFormat format);

/// As registered with IANA, which knows none for PLY and Draco.
std::string_view media_type(LodFormat format);

}  // namespace pmesh
