#include "protocol/lod_format.h"

#include <array>

namespace pmesh {
namespace {

struct Row {
  LodFormat format;
  std::string_view ending, name, media_type;
};

constexpr std::array kRows = {
    Row{LodFormat::glb, "glb", "glb", "model/gltf-binary"},
    Row{LodFormat::glb_draco, "glb", "glb-draco", "model/gltf-binary"},
    Row{LodFormat::ply, "ply", "ply", "application/octet-stream"},
    Row{LodFormat::obj, "obj", "obj", "model/obj"},
    Row{LodFormat::drc, "drc", "drc", "application/octet-stream"},
};

const Row& row_of(LodFormat format) { return kRows[static_cast<std::size_t>(format)]; }

}  // namespace

std::optional<LodFormat> lod_format_of(std::string_view ending, bool draco) {
  for (const Row& row : kRows) {
    if (row.ending != ending) continue;
    return draco && row.format == LodFormat::glb ? LodFormat::glb_draco : row.format;
  }
  return std::nullopt;
}

std::string_view file_ending(LodFormat format) { return row_of(format).ending; }
std::string_view format_name(LodFormat format) { return row_of(format).name; }
std::string_view media_type(LodFormat format) { return row_of(format).media_type; }

}  // namespace pmesh
