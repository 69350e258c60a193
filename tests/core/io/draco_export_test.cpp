#include "core/io/draco_export.h"

#include <algorithm>
#include <cmath>

#include <draco/compression/decode.h>
#include <gtest/gtest.h>

#include "core/io/single_precision.h"
#include "tests/core/io/lattice_meshes.h"

namespace pmesh {
namespace {

struct Decoded {
  draco::DataType type{};
  IndexedMesh mesh;
};

Decoded decode(const Bytes& bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
  const draco::PointAttribute& positions = *mesh->GetAttributeByUniqueId(kDracoPositionId);
  Decoded decoded{positions.data_type(), {}};
  for (draco::PointIndex p(0); p < mesh->num_points(); ++p) {
    Vec3d& position = decoded.mesh.positions.emplace_back();
    positions.ConvertValue<double, 3>(positions.mapped_index(p), &position.x);
  }
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh->face(f);
    decoded.mesh.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return decoded;
}

Vec3i nearest(const Lattice& lattice, Vec3d p) {
  const auto index = [&](double c, double low) {
    return static_cast<std::int32_t>(std::lround((c - low) / lattice.step));
  };
  return {index(p.x, lattice.origin.x), index(p.y, lattice.origin.y), index(p.z, lattice.origin.z)};
}

/// The lattice points next to the decoded positions; `worst` is how far those are off, in steps.
LatticeMesh snapped(const IndexedMesh& mesh, const Lattice& lattice, double& worst) {
  LatticeMesh points{{}, mesh.triangles};
  for (const Vec3d p : mesh.positions) {
    points.positions.push_back(nearest(lattice, p));
    const Vec3d off = p - lattice.position(points.positions.back());
    worst = std::max({worst, std::abs(off.x) / lattice.step, std::abs(off.y) / lattice.step,
                      std::abs(off.z) / lattice.step});
  }
  return points;
}

/// Checks that `shape` comes back; gives how far its positions are off, in steps.
double expect_kept(const LatticeShape& shape, DracoNumbers numbers = DracoNumbers::floats) {
  SCOPED_TRACE(shape.name);
  const DracoExport coded = export_draco(shape.mesh, shape.lattice, numbers).value();
  const Decoded decoded = decode(coded.bytes);
  EXPECT_EQ(coded.vertices, decoded.mesh.positions.size());
  EXPECT_EQ(coded.faces, shape.mesh.triangles.size());
  double worst = 0;
  EXPECT_TRUE(same_triangles(snapped(decoded.mesh, shape.lattice, worst), shape.mesh));
  return worst;
}

LatticeShape sphere(int bits) { return on_lattice({"sphere", shapes::icosphere(3)}, bits); }

TEST(DracoExport, KeepsEveryShapeWithinAHundredthOfAStep) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    for (const int bits : {4, 10, 14}) EXPECT_LE(expect_kept(on_lattice(shape, bits)), 0.01);
  }
}

TEST(DracoExport, KeepsMeshesOfAnySize) {
  for (const double step : {1e-20, 1e-9, 1e-3, 1.0, 1e9, 1e20}) {
    LatticeShape shape = sphere(12);
    shape.lattice = {{-2000 * step, -2000 * step, 0}, step, 12};
    EXPECT_LE(expect_kept(shape), 0.01) << step;
  }
}

TEST(DracoExport, IsOffByTwoRoundingsWhereFloatsCanDoNoBetter) {
  for (const int bits : {16, 18, 20, 22}) {
    for (const double offset : {0.0, 0.7, -3.0}) {
      LatticeShape shape = sphere(bits);
      shape.lattice.origin = {offset, offset, -offset};
      if (!fits_single_precision(shape.lattice)) continue;
      const double rounding = float_rounding(largest_coordinate(shape.lattice));
      EXPECT_LE(expect_kept(shape), std::max(0.01, 2 * rounding / shape.lattice.step))
          << bits << ' ' << offset;
    }
  }
}

TEST(DracoExport, IsExactWhereALatticeIsOneOfFloats) {
  LatticeShape shape = sphere(16);
  shape.lattice = {{-4, 16, 0.5}, 1.0 / 4096, 16};
  EXPECT_EQ(expect_kept(shape), 0);
}

TEST(DracoExport, KeepsDoublesWhereFloatsWouldLoseSteps) {
  LatticeShape shape = sphere(20);
  shape.lattice.origin = {5'000'000.1, -4e6, 0.3};
  const Bytes bytes =
      export_draco(shape.mesh, shape.lattice, DracoNumbers::doubles_if_needed)->bytes;
  EXPECT_EQ(decode(bytes).type, draco::DT_FLOAT64);
  EXPECT_EQ(expect_kept(shape, DracoNumbers::doubles_if_needed), 0);

  const Bytes floats = export_draco(shape.mesh, shape.lattice, DracoNumbers::floats)->bytes;
  EXPECT_EQ(decode(floats).type, draco::DT_FLOAT32);
}

TEST(DracoExport, RefusesWhatSpansMoreThanFloats) {
  const Lattice lattice{{-3e38, -3e38, -3e38}, 6e38 / 4095, 12};
  const auto refused = export_draco(sphere(12).mesh, lattice, DracoNumbers::floats);
  EXPECT_EQ(refused.error().code, ErrorCode::runtime);
}

TEST(DracoExport, WritesOneFace) {
  EXPECT_EQ(expect_kept({"face", {{{0, 0, 0}, {9, 2, 0}, {5, 10, 7}}, {{0, 1, 2}}}, {{}, 1, 4}}),
            0);
}

TEST(DracoExport, WritesAFaceWithoutASurface) {
  EXPECT_EQ(expect_kept({"point", {{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}, {{0, 1, 2}}}, {{}, 1, 4}}),
            0);
  EXPECT_EQ(expect_kept({"twice", {{{0, 0, 0}, {9, 2, 0}}, {{0, 1, 1}}}, {{}, 1, 4}}), 0);
}

TEST(DracoExport, WritesWhatIsNoManifold) {
  for (const shapes::Shape& shape : shapes::non_manifolds()) expect_kept(on_lattice(shape, 10));
}

TEST(DracoExport, TheSameMeshGivesTheSameBytes) {
  const LatticeShape shape = sphere(12);
  const auto once = export_draco(shape.mesh, shape.lattice, DracoNumbers::floats);
  EXPECT_EQ(export_draco(shape.mesh, shape.lattice, DracoNumbers::floats)->bytes, once->bytes);
}

}  // namespace
}  // namespace pmesh
