#include "core/io/parsers.h"

#include <algorithm>
#include <cctype>

namespace pmesh {

Status append_polygon(ImportedMesh& out, std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) {
    return bad_input("expected 3 or more corners, found " + std::to_string(corners.size()));
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    out.mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
  out.polygons += corners.size() > 3;
  return {};
}

bool is_padding(ByteView bytes) {
  return std::all_of(bytes.begin(), bytes.end(),
                     [](std::uint8_t byte) { return byte == 0 || std::isspace(byte) != 0; });
}

std::string index_out_of_range(std::int64_t index, std::uint64_t vertices) {
  return "vertex index " + std::to_string(index) + " is out of range: the mesh has " +
         std::to_string(vertices) + " vertices";
}

}  // namespace pmesh
