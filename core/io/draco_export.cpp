#include "core/io/draco_export.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <new>
#include <optional>
#include <string>

#include "core/draco/encode.h"
#include "core/io/single_precision.h"

namespace pmesh {
namespace {

constexpr int kSpeed = 5;  // Draco's default, of 0 (smallest) to 10 (fastest)

/// The most bits that Draco's encoder, which counts in floats, quantises without an error.
constexpr int kMostBits = 23;

/// How Draco's decoder makes floats of integers: origin + (range / (2^bits - 1)) * integer.
struct Dequantization {
  std::array<float, 3> origin{};
  float range = 0;
  int bits = 0;

  float last() const { return std::ldexp(1.0f, bits) - 1; }
};

double largest_of(Vec3d v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The lattice itself; nothing if a decoder's floats would miss it by more than 1/100 of a step.
std::optional<Dequantization> on_lattice(const Lattice& lattice) {
  if (lattice.bits > kMostBits) return std::nullopt;
  const Vec3<float> origin = to_single(lattice.origin);
  Dequantization grid{{origin.x, origin.y, origin.z}, 0, lattice.bits};
  grid.range = static_cast<float>(lattice.step * grid.last());

  const double last = grid.last();
  const double origin_error = largest_of(lattice.origin - Vec3d{origin.x, origin.y, origin.z});
  const double step_error = std::abs(grid.range / grid.last() - lattice.step) * last;
  const double rounding =
      float_rounding(lattice.step * last) + float_rounding(largest_coordinate(lattice));
  const bool near = origin_error + step_error + rounding <= lattice.step / 100;
  return near ? std::optional(grid) : std::nullopt;
}

/// A grid on which floats compute exactly: steps of a power of two, the origin a multiple of it.
Dequantization on_floats(const Lattice& lattice) {
  const double side = lattice.step * (std::ldexp(1.0, lattice.bits) - 1);
  const double reach = std::max(largest_coordinate(lattice), side);
  Dequantization grid{{}, 0, kMostBits};
  double step = std::ldexp(1.0, std::ilogb(reach) + 1 - kMostBits);
  if (side + step > step * grid.last()) step *= 2;  // the origin is rounded down
  grid.range = static_cast<float>(step * grid.last());
  const Vec3d low = lattice.origin;
  std::ranges::transform(std::array{low.x, low.y, low.z}, grid.origin.begin(),
                         [&](double c) { return static_cast<float>(std::floor(c / step) * step); });
  return grid;
}

/// The integers of a grid, as the floats that Draco's encoder takes.
std::vector<Vec3<float>> to_grid(const LatticeMesh& mesh, const Lattice& lattice,
                                 const Dequantization& grid) {
  const double step = static_cast<double>(grid.range) / grid.last();
  const auto nearest = [&](double coordinate, float low) {
    return static_cast<float>(
        std::clamp<double>(std::round((coordinate - low) / step), 0, grid.last()));
  };
  std::vector<Vec3<float>> points;
  points.reserve(mesh.positions.size());
  for (const Vec3i position : mesh.positions) {
    const Vec3d p = lattice.position(position);
    points.push_back(
        {nearest(p.x, grid.origin[0]), nearest(p.y, grid.origin[1]), nearest(p.z, grid.origin[2])});
  }
  return points;
}

Bytes bytes_of(const Dequantization& grid) {
  Bytes bytes;
  ByteWriter writer(bytes);
  for (const float low : grid.origin) writer.put(std::bit_cast<std::uint32_t>(low));
  writer.put(std::bit_cast<std::uint32_t>(grid.range));
  writer.put(static_cast<std::uint8_t>(grid.bits));
  return bytes;
}

/// Puts another dequantization in the place of `before`: the last bytes of a mesh with one
/// attribute, as Draco's bitstream is laid out. Draco's encoder itself takes origin and range with
/// six decimals only, which is no origin and no range for a mesh of millimetres.
Status set_dequantization(Bytes& bytes, const Dequantization& before, const Dequantization& after) {
  const Bytes expected = bytes_of(before), wanted = bytes_of(after);
  if (bytes.size() < expected.size() ||
      !std::equal(expected.rbegin(), expected.rend(), bytes.rbegin())) {
    return runtime_error("Draco: the dequantization is not where it should be");
  }
  std::ranges::copy(wanted, bytes.end() - static_cast<std::ptrdiff_t>(wanted.size()));
  return {};
}

/// `grid`: of points that are to be quantised; null for those that are not.
Result<DracoExport> encode(const draco::Mesh& mesh, const Dequantization* grid, int method) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(kSpeed, kSpeed);
  encoder.SetEncodingMethod(method);
  encoder.SetTrackEncodedProperties(true);
  const Dequantization integers =
      grid ? Dequantization{.range = grid->last(), .bits = grid->bits} : Dequantization{};
  if (grid) {
    encoder.SetAttributeExplicitQuantization(kDracoPositionId, integers.bits, 3,
                                             integers.origin.data(), integers.range);
  }
  Result<Bytes> bytes = run_draco(encoder);
  if (!bytes) return bytes.error();
  if (grid) {
    if (Status set = set_dequantization(*bytes, integers, *grid); !set) return set.error();
  }
  return DracoExport{std::move(*bytes), static_cast<std::uint32_t>(encoder.num_encoded_points()),
                     static_cast<std::uint32_t>(encoder.num_encoded_faces())};
}

Result<DracoExport> encode(const draco::Mesh& mesh, const Dequantization* grid) {
  Result<DracoExport> coded = encode(mesh, grid, draco::MESH_EDGEBREAKER_ENCODING);
  // Sequential coding, at several times the bytes, keeps what EdgeBreaker leaves out: faces that
  // use a vertex twice.
  if (coded && coded->faces == mesh.num_faces()) return coded;
  return encode(mesh, grid, draco::MESH_SEQUENTIAL_ENCODING);
}

Result<DracoExport> export_quantised(const LatticeMesh& mesh, const Lattice& lattice) {
  const Dequantization grid = on_lattice(lattice).value_or(on_floats(lattice));
  if (!std::isfinite(grid.range)) return runtime_error("the mesh is too large for Draco's floats");
  return encode(*make_draco_mesh(to_grid(mesh, lattice, grid), mesh.triangles), &grid);
}

Result<DracoExport> export_doubles(const LatticeMesh& mesh, const Lattice& lattice) {
  std::vector<Vec3d> positions(mesh.positions.size());
  std::ranges::transform(mesh.positions, positions.begin(),
                         [&](Vec3i point) { return lattice.position(point); });
  return encode(*make_draco_mesh(positions, mesh.triangles), nullptr);
}

}  // namespace

Result<DracoExport> export_draco(const LatticeMesh& mesh, const Lattice& lattice,
                                 DracoNumbers numbers) {
  assert(!mesh.triangles.empty());
  const bool as_doubles =
      numbers == DracoNumbers::doubles_if_needed && !fits_single_precision(lattice);
  try {
    return as_doubles ? export_doubles(mesh, lattice) : export_quantised(mesh, lattice);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, "out of memory while encoding with Draco"};
  }
}

}  // namespace pmesh
