#include "core/io/export.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "core/files/read_file.h"
#include "tests/core/io/import_checks.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

const Lattice kUnit{{0, 0, 0}, 0.5, 10};
// A step of a tenth of a millimetre, 5,000 km from the origin.
const Lattice kFarAway{{5'000'000.1, -4e6, 0.3}, 1e-4, 20};

const LatticeMesh kMesh{{{0, 0, 0}, {1023, 2, 0}, {5, 1000, 7}, {1, 2, 3}}, {{0, 1, 2}, {3, 2, 1}}};

std::string text_of(ExportFormat format, const LatticeMesh& mesh, const Lattice& lattice) {
  const Bytes bytes = format_mesh(format, mesh, lattice).value();
  return {bytes.begin(), bytes.end()};
}

TEST(FitsSinglePrecision, ComparesTheStepWithTheLargestCoordinate) {
  EXPECT_TRUE(fits_single_precision(kUnit));
  EXPECT_FALSE(fits_single_precision(kFarAway));
  EXPECT_FALSE(fits_single_precision({{1e39, 0, 0}, 1, 10}));
  EXPECT_TRUE(fits_single_precision({{0, 0, 0}, 1, 22}));
  EXPECT_FALSE(fits_single_precision({{0, 0, 0}, 1, 23}));
  EXPECT_FALSE(fits_single_precision({{0, 0, 0}, 1e-45, 10}));
}

TEST(FitsSinglePrecision, KeepsEveryPositionWithinAnEighthOfAStep) {
  for (const double offset : {0.0, 1.0, -1000.0, 4095.0, 1e5, 1e6, 1e7}) {
    const Lattice lattice{{offset, 0, 0}, 1.0 / 64, 12};
    double worst = 0;
    for (int i = 0; i < 4096; ++i) {
      const double x = lattice.position({i, 0, 0}).x;
      worst = std::max(worst, std::abs(static_cast<double>(static_cast<float>(x)) - x));
    }
    if (fits_single_precision(lattice)) {
      EXPECT_LE(worst, lattice.step / 8) << offset;
    }
  }
}

TEST(Export, ImportGivesThePositionsAndTrianglesBack) {
  for (const auto& [as, format] : {std::pair(ExportFormat::ply, MeshFormat::ply),
                                   std::pair(ExportFormat::obj, MeshFormat::obj)}) {
    const ImportedMesh back = parsed(format, text_of(as, kMesh, kFarAway));
    EXPECT_EQ(back.mesh.triangles, kMesh.triangles);
    ASSERT_EQ(back.mesh.positions.size(), kMesh.positions.size());
    for (std::size_t i = 0; i < kMesh.positions.size(); ++i) {
      EXPECT_EQ(back.mesh.positions[i], kFarAway.position(kMesh.positions[i]));
    }
  }
}

TEST(Export, SinglePrecisionGivesTheSameFloatsInBothFormats) {
  const Lattice lattice{{0.1, 0.2, 0.3}, 0.01, 10};
  ASSERT_TRUE(fits_single_precision(lattice));
  const ImportedMesh ply = parsed(MeshFormat::ply, text_of(ExportFormat::ply, kMesh, lattice));
  const ImportedMesh obj = parsed(MeshFormat::obj, text_of(ExportFormat::obj, kMesh, lattice));
  for (std::size_t i = 0; i < kMesh.positions.size(); ++i) {
    const Vec3d a = ply.mesh.positions[i];
    const Vec3d b = obj.mesh.positions[i];
    EXPECT_EQ(static_cast<float>(b.x), static_cast<float>(a.x));
    EXPECT_EQ(a.x, static_cast<double>(static_cast<float>(lattice.position(kMesh.positions[i]).x)));
  }
}

// In a row, as compilers treat such loops in their own ways.
TEST(ExportedPositions, AreThoseOfAFile) {
  const Lattice lattice{{0.1, 0.2, 0.3}, 0.001, 12};
  LatticeMesh mesh;
  for (int i = 0; i < 1000; ++i) mesh.positions.push_back({i, 2 * i, 3 * i});
  mesh.triangles = {{0, 1, 2}};
  const ExportedPositions exported(lattice);
  std::vector<Vec3d> positions(mesh.positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = exported(mesh.positions[i]);
  EXPECT_EQ(parsed(MeshFormat::ply, text_of(ExportFormat::ply, mesh, lattice)).mesh.positions,
            positions);
}

TEST(Export, PlyIsPinned) {
  const std::string ply = text_of(ExportFormat::ply, {{{1, 2, 0}}, {{0, 0, 0}}}, kUnit);
  EXPECT_EQ(ply,
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
            "property float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n" +
                bytes_of(0.5f) + bytes_of(1.0f) + bytes_of(0.0f) + '\3' + std::string(12, '\0'));
}

TEST(Export, ObjIsPinned) {
  EXPECT_EQ(text_of(ExportFormat::obj, kMesh, kUnit),
            "v 0 0 0\nv 511.5 1 0\nv 2.5 500 3.5\nv 0.5 1 1.5\nf 1 2 3\nf 4 3 2\n");
}

TEST(Export, WritesTheFileThatTheExtensionNames) {
  const TemporaryDirectory folder;
  for (const char* name : {"out.ply", "out.OBJ"}) {
    const std::string path = (folder / name);
    ASSERT_TRUE(export_mesh(path, kMesh, kUnit).ok());
    const Result<ImportedMesh> back = import_mesh(path);
    ASSERT_TRUE(back.ok());
    EXPECT_EQ(back->mesh.triangles, kMesh.triangles);
  }
}

TEST(Export, KnowsFormatsByExtension) {
  EXPECT_EQ(export_format_of("a/b.ply"), ExportFormat::ply);
  EXPECT_EQ(export_format_of("A.GLB"), ExportFormat::glb);
  EXPECT_EQ(export_format_of("x.y.Drc"), ExportFormat::drc);
  EXPECT_EQ(export_format_of("x.obj"), ExportFormat::obj);
  for (const char* path : {"", "glb", "a.stl", "a.gltf", "a.glb.gz"}) {
    EXPECT_EQ(export_format_of(path), std::nullopt) << path;
  }
}

TEST(Export, WritesGlbAndDracoFiles) {
  const TemporaryDirectory folder;
  ASSERT_TRUE(export_mesh(folder / "out.glb", kMesh, kUnit).ok());
  ASSERT_TRUE(export_mesh(folder / "out.drc", kMesh, kUnit).ok());
  EXPECT_TRUE(contents(folder / "out.glb").starts_with("glTF"));
  EXPECT_TRUE(contents(folder / "out.drc").starts_with("DRACO"));
}

TEST(Export, RefusesOtherFormats) {
  const Status written = export_mesh("out.stl", kMesh, kUnit);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code, ErrorCode::usage);
  EXPECT_EQ(written.error().message, "out.stl: meshes are written as .ply, .obj, .glb or .drc");
}

TEST(Import, ErrorsBeginWithTheFilesName) {
  const TemporaryDirectory folder;
  const std::string path = (folder / "bad.obj");
  put_contents(path, "v 1 2\n");
  EXPECT_EQ(import_mesh(path).error().message, path + ": line 1: expected 3 numbers, found 2");
  EXPECT_EQ(import_mesh("mesh.glb").error().code, ErrorCode::usage);
  EXPECT_EQ(import_mesh("absent.ply").error().message,
            "absent.ply: cannot open: No such file or directory");
}

TEST(Import, KnowsFormatsByExtension) {
  EXPECT_EQ(mesh_format_of("a/b.ply"), MeshFormat::ply);
  EXPECT_EQ(mesh_format_of("A.OBJ"), MeshFormat::obj);
  EXPECT_EQ(mesh_format_of("x.y.Stl"), MeshFormat::stl);
  EXPECT_EQ(mesh_format_of(".off"), MeshFormat::off);
  for (const char* path : {"", "ply", "a.glb", "a.ply.gz", "off"}) {
    EXPECT_EQ(mesh_format_of(path), std::nullopt) << path;
  }
}

}  // namespace
}  // namespace pmesh
