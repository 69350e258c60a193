#include "core/io/export.h"

#include <bit>
#include <charconv>
#include <utility>

#include "core/files/atomic_file.h"
#include "core/files/out_of_memory.h"
#include "core/io/draco_export.h"
#include "core/io/extension.h"
#include "core/io/glb_export.h"

namespace pmesh {
namespace {

constexpr std::size_t kPlyFaceBytes = 13;  // A length of one byte and three indices.

void append_text(Bytes& out, std::string_view text) {
  const ByteView bytes = as_bytes(text);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

std::string ply_header(const LatticeMesh& mesh, bool single) {
  const std::string type = single ? "float" : "double";
  return "ply\nformat binary_little_endian 1.0\nelement vertex " +
         std::to_string(mesh.positions.size()) + "\nproperty " + type + " x\nproperty " + type +
         " y\nproperty " + type + " z\nelement face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

Bytes format_ply(const LatticeMesh& mesh, const Lattice& lattice, bool single) {
  const std::string header = ply_header(mesh, single);
  Bytes out;
  out.reserve(header.size() + 3 * (single ? 4 : 8) * mesh.positions.size() +
              kPlyFaceBytes * mesh.triangles.size());
  append_text(out, header);
  ByteWriter writer(out);
  for (const Vec3i point : mesh.positions) {
    const Vec3d position = lattice.position(point);
    for (const double coordinate : {position.x, position.y, position.z}) {
      if (single) {
        writer.put(std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
      } else {
        writer.put(coordinate);
      }
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    writer.put(std::uint8_t{3});
    for (const std::uint32_t corner : triangle) writer.put(corner);
  }
  return out;
}

// A blank and the shortest decimal that reads back as `number`.
template <class Number>
void append_number(Bytes& out, Number number) {
  char digits[32] = {' '};
  const auto written = std::to_chars(digits + 1, digits + sizeof digits, number);
  append_text(out, {digits, static_cast<std::size_t>(written.ptr - digits)});
}

Bytes format_obj(const LatticeMesh& mesh, const Lattice& lattice, bool single) {
  Bytes out;
  for (const Vec3i point : mesh.positions) {
    const Vec3d position = lattice.position(point);
    append_text(out, "v");
    for (const double coordinate : {position.x, position.y, position.z}) {
      if (single) {
        append_number(out, static_cast<float>(coordinate));
      } else {
        append_number(out, coordinate);
      }
    }
    append_text(out, "\n");
  }
  for (const Triangle& triangle : mesh.triangles) {
    append_text(out, "f");
    for (const std::uint32_t corner : triangle) append_number(out, std::uint64_t{corner} + 1);
    append_text(out, "\n");
  }
  return out;
}

}  // namespace

std::optional<ExportFormat> export_format_of(std::string_view path) {
  constexpr std::pair<std::string_view, ExportFormat> kExtensions[] = {{".ply", ExportFormat::ply},
                                                                       {".obj", ExportFormat::obj},
                                                                       {".glb", ExportFormat::glb},
                                                                       {".drc", ExportFormat::drc}};
  return format_by_extension(path, kExtensions);
}

Result<Bytes> format_mesh(ExportFormat format, const LatticeMesh& mesh, const Lattice& lattice) {
  switch (format) {
    case ExportFormat::ply:
      return format_ply(mesh, lattice, fits_single_precision(lattice));
    case ExportFormat::obj:
      return format_obj(mesh, lattice, fits_single_precision(lattice));
    case ExportFormat::glb:
      return format_glb(mesh, lattice, GlbGeometry::accessors);
    case ExportFormat::glb_draco:
      return format_glb(mesh, lattice, GlbGeometry::draco);
    case ExportFormat::drc:
      break;
  }
  Result<DracoExport> coded = export_draco(mesh, lattice, DracoNumbers::doubles_if_needed);
  if (!coded) return coded.error();
  return std::move(coded->bytes);
}

Status export_mesh(const std::string& path, const LatticeMesh& mesh, const Lattice& lattice) {
  const std::optional<ExportFormat> format = export_format_of(path);
  if (!format) {
    return Error{ErrorCode::usage,
                 path + ": meshes are written as " + std::string(kExportExtensions)};
  }
  const Result<Bytes> bytes =
      catching_out_of_memory([&] { return format_mesh(*format, mesh, lattice); });
  if (!bytes) return prefixed(path, bytes.error());
  return write_file(path, *bytes, Overwrite::yes);
}

}  // namespace pmesh
