// The promise of the error index: never below what compare_surfaces() finds, whatever its samples
// and seed, and at most 1.25 times that.
#include "core/measure/level_errors.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/io/clean.h"
#include "core/io/import.h"
#include "core/measure/compare.h"
#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "core/refine/refinable_mesh.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/real_meshes.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

IndexedMesh in_space(const LatticeMesh& lod, const Lattice& lattice) {
  IndexedMesh mesh{{}, lod.triangles};
  for (const Vec3i p : lod.positions) mesh.positions.push_back(lattice.position(p));
  return mesh;
}

// The file's LODs at some numbers of splits, from the base to the full mesh.
std::vector<IndexedMesh> levels_of(const EncodedShape& shape, std::uint32_t count) {
  StreamDecoder decoder(decode_base);
  EXPECT_TRUE(decoder.feed(shape.file));
  RefinableMesh& mesh = decoder.mesh();
  std::vector<IndexedMesh> levels;
  const std::uint32_t splits = mesh.known_steps();
  for (std::uint32_t i = 0; i <= count; ++i) {
    mesh.set_steps(splits * i / count);
    levels.push_back(in_space(mesh.snapshot(), shape.lattice));
  }
  return levels;
}

LevelErrors errors_of(const IndexedMesh& original, unsigned threads = 1) {
  const MeshView view{original.positions, original.triangles};
  return LevelErrors(view, *unit_frame(box_of_faces(view)), {.threads = threads});
}

LevelError measured(LevelErrors& errors, const IndexedMesh& lod) {
  FaceErrors nothing_known(lod.triangles.size());
  return errors.measure({lod.positions, lod.triangles}, nothing_known);
}

void expect_promise(const std::string& name, const IndexedMesh& original, const IndexedMesh& lod,
                    const LevelError& error) {
  const auto found = compare_surfaces(original, lod, {.samples = 20'000, .seed = 0, .threads = 1});
  const auto more = compare_surfaces(original, lod, {.samples = 60'000, .seed = 7, .threads = 1});
  ASSERT_TRUE(found && more);
  EXPECT_GE(error.max_error, found->max()) << name;
  EXPECT_GE(error.max_error, more->max()) << name;
  EXPECT_LE(error.max_error, 1.25 * found->max()) << name;
  // A few spikes on a flat surface are met by chance.
  EXPECT_NEAR(error.rms_error, more->rms(), 0.05 * more->rms() + 0.01 * more->max()) << name;
}

TEST(LevelErrors, KeepTheirPromiseForEveryShape) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    const EncodedShape file = encode_shape(shape.name, shape.mesh, 10);
    LevelErrors errors = errors_of(shape.mesh);
    for (const IndexedMesh& lod : levels_of(file, 4)) {
      expect_promise(shape.name, shape.mesh, lod, measured(errors, lod));
    }
  }
}

TEST(LevelErrors, KeepTheirPromiseFromFineToCoarse) {
  const IndexedMesh original = shapes::bumped(shapes::icosphere(4), 0.1);
  std::vector<IndexedMesh> levels = levels_of(encode_shape("bumped", original), 6);
  LevelErrors errors = errors_of(original);
  for (auto lod = levels.rbegin(); lod != levels.rend(); ++lod) {
    expect_promise("bumped", original, *lod, measured(errors, *lod));
  }
}

TEST(LevelErrors, KeepTheirPromiseForUnrelatedLevels) {
  const IndexedMesh original = shapes::torus(30, 20);
  LevelErrors errors = errors_of(original);
  for (const IndexedMesh& lod : {shapes::torus(9, 7), shapes::genus(2), shapes::torus(12, 12),
                                 shapes::tetrahedron(), shapes::torus(30, 20)}) {
    const LevelError error = measured(errors, lod);
    const auto found =
        compare_surfaces(original, lod, {.samples = 20'000, .seed = 0, .threads = 1});
    EXPECT_GE(error.max_error, found->max());
    EXPECT_LE(error.max_error, 1.25 * found->max());
  }
}

TEST(LevelErrors, AreNothingForTheMeshItself) {
  const IndexedMesh original = shapes::genus(3);
  LevelErrors errors = errors_of(original);
  EXPECT_EQ(measured(errors, original).max_error, 0);
  EXPECT_EQ(measured(errors, original).rms_error, 0);
}

TEST(LevelErrors, AreTheSameWhateverTheThreads) {
  const IndexedMesh original = shapes::bumped(shapes::torus(60, 30), 0.05);
  LevelErrors one = errors_of(original, 1), many = errors_of(original, 4);
  for (const IndexedMesh& lod : levels_of(encode_shape("torus", original), 5)) {
    const LevelError a = measured(one, lod), b = measured(many, lod);
    EXPECT_EQ(a.max_error, b.max_error);
    EXPECT_EQ(a.rms_error, b.rms_error);
  }
}

TEST(LevelErrors, TightenWhatIsKnown) {
  const IndexedMesh original = shapes::icosphere(4), lod = shapes::icosphere(2);
  LevelErrors errors = errors_of(original);
  FaceErrors known(lod.triangles.size());
  const double max_error = errors.measure({lod.positions, lod.triangles}, known).max_error;
  for (const std::vector<double>& bounds : {known.to_original, known.from_original}) {
    EXPECT_LE(*std::max_element(bounds.begin(), bounds.end()), max_error);
  }
  EXPECT_LT(0, *std::max_element(known.from_original.begin(), known.from_original.end()));
}

TEST(LevelErrors, BelieveWhatIsKnown) {
  const IndexedMesh original = shapes::icosphere(4), lod = shapes::icosphere(2);
  LevelErrors errors = errors_of(original);
  const double far = measured(errors, lod).max_error * 1.1;  // within the tolerance
  FaceErrors known(lod.triangles.size());
  known.to_original.assign(lod.triangles.size(), far);
  known.from_original.assign(lod.triangles.size(), far);
  EXPECT_NEAR(errors.measure({lod.positions, lod.triangles}, known).max_error, far, 1e-9);
}

TEST(LevelErrors, HaveNoFrameForAMeshTooLargeToBeMeasured) {
  const IndexedMesh huge{{{-1.7e308, 0, 0}, {1.7e308, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_FALSE(unit_frame(box_of_faces({huge.positions, huge.triangles})));
}

TEST(LevelErrors, KeepTheirPromiseForARealMesh) {
  PMESH_NEED_REAL_MESH(path, "fandisk.obj");
  Result<ImportedMesh> imported = import_mesh(path);
  ASSERT_TRUE(imported);
  const IndexedMesh original = clean(std::move(*imported)).mesh;
  LevelErrors errors = errors_of(original, 2);
  for (const IndexedMesh& lod : levels_of(encode_shape("fandisk", original, 14), 5)) {
    expect_promise("fandisk", original, lod, measured(errors, lod));
  }
}

}  // namespace
}  // namespace pmesh
