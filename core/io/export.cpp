#include "core/io/export.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <string_view>

#include "core/files/atomic_file.h"

namespace pmesh {
namespace {

constexpr std::size_t kPlyFaceBytes = 13;  // A length of one byte and three indices.

double largest_coordinate(const Lattice& lattice) {
  const double extent = lattice.step * (std::ldexp(1.0, lattice.bits) - 1);
  double largest = 0;
  for (const double low : {lattice.origin.x, lattice.origin.y, lattice.origin.z}) {
    largest = std::max({largest, std::abs(low), std::abs(low + extent)});
  }
  return largest;
}

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

bool fits_single_precision(const Lattice& lattice) {
  const double largest = largest_coordinate(lattice);
  if (!(largest <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
  if (largest == 0) return true;
  // Rounding is off by at most half the gap between neighbouring floats of that size.
  const int exponent = std::max(std::ilogb(largest), std::numeric_limits<float>::min_exponent - 1);
  const double gap = std::ldexp(1.0, exponent + 1 - std::numeric_limits<float>::digits);
  return gap / 2 <= lattice.step / 8;
}

Vec3<float> ExportedPositions::to_single(Vec3d p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

Bytes format_mesh(MeshFormat format, const LatticeMesh& mesh, const Lattice& lattice) {
  assert(format == MeshFormat::ply || format == MeshFormat::obj);
  const bool single = fits_single_precision(lattice);
  return format == MeshFormat::ply ? format_ply(mesh, lattice, single)
                                   : format_obj(mesh, lattice, single);
}

Status export_mesh(const std::string& path, const LatticeMesh& mesh, const Lattice& lattice) {
  const std::optional<MeshFormat> format = mesh_format_of(path);
  if (format != MeshFormat::ply && format != MeshFormat::obj) {
    return Error{ErrorCode::usage, path + ": meshes are written as .ply or .obj"};
  }
  try {
    return write_file(path, format_mesh(*format, mesh, lattice), Overwrite::yes);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, path + ": not enough memory to write the mesh"};
  }
}

}  // namespace pmesh
