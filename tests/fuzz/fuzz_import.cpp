// Fuzzes the mesh importers: the first byte chooses the format, the others are the file.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "core/io/import.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void require_sound(const pmesh::IndexedMesh& mesh) {
  require(!mesh.triangles.empty());
  for (const pmesh::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) require(corner < mesh.positions.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto format = static_cast<pmesh::MeshFormat>(data[0] % 4);
  const auto imported = pmesh::parse_mesh(format, {data + 1, size - 1});
  if (imported.ok()) {
    require_sound(imported->mesh);
  } else {
    require(imported.error().code == pmesh::ErrorCode::bad_input);
  }
  return 0;
}
