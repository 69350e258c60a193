#include "core/io/import.h"

#include <new>
#include <utility>

#include "core/base/ids.h"
#include "core/files/read_file.h"
#include "core/io/extension.h"
#include "core/io/parsers.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{64} << 30;
// Corners and vertices are numbered by 32 bits, and the last number means none.
constexpr std::size_t kMostVertices = kNoIndex;
constexpr std::size_t kMostTriangles = kNoIndex / 3;

Result<ImportedMesh> parse(MeshFormat format, ByteView bytes) {
  switch (format) {
    case MeshFormat::ply:
      return parse_ply(bytes);
    case MeshFormat::obj:
      return parse_obj(bytes);
    case MeshFormat::stl:
      return parse_stl(bytes);
    case MeshFormat::off:
      return parse_off(bytes);
  }
  return Error{ErrorCode::usage, "unknown mesh format"};
}

Status check_size(const IndexedMesh& mesh) {
  if (mesh.triangles.empty()) return bad_input("the mesh has no faces");
  if (mesh.positions.size() > kMostVertices || mesh.triangles.size() > kMostTriangles) {
    return Error{ErrorCode::out_of_resources, "the mesh has too many vertices or faces"};
  }
  return {};
}

}  // namespace

std::optional<MeshFormat> mesh_format_of(std::string_view path) {
  constexpr std::pair<std::string_view, MeshFormat> kExtensions[] = {{".ply", MeshFormat::ply},
                                                                     {".obj", MeshFormat::obj},
                                                                     {".stl", MeshFormat::stl},
                                                                     {".off", MeshFormat::off}};
  return format_by_extension(path, kExtensions);
}

Result<ImportedMesh> parse_mesh(MeshFormat format, ByteView bytes) {
  try {
    Result<ImportedMesh> parsed = parse(format, bytes);
    if (!parsed.ok()) return parsed;
    if (Status checked = check_size(parsed->mesh); !checked.ok()) return checked.error();
    return parsed;
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, "not enough memory for the mesh"};
  }
}

Result<ImportedMesh> import_mesh(const std::string& path) {
  const std::optional<MeshFormat> format = mesh_format_of(path);
  if (!format) {
    return Error{ErrorCode::usage,
                 path + ": unknown mesh format; known are .ply, .obj, .stl, .off"};
  }
  const Result<Bytes> bytes = read_file(path, kLargestFile);
  if (!bytes.ok()) return bytes.error();
  Result<ImportedMesh> parsed = parse_mesh(*format, *bytes);
  if (!parsed.ok()) return prefixed(path, parsed.error());
  return parsed;
}

}  // namespace pmesh
