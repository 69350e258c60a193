#include "core/precompute/precompute.h"

#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "core/files/read_file.h"
#include "core/measure/compare.h"
#include "core/pm/pm_file.h"
#include "core/pm/verify.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/real_meshes.h"
#include "tests/fixtures/shapes.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

const PrecomputeProgress kSilent = [](PrecomputePhase, double) {};

std::string obj_text(const IndexedMesh& mesh) {
  std::string text;
  char line[128];
  for (const Vec3d& p : mesh.positions) {
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p.x, p.y, p.z);
    text += line;
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    std::snprintf(line, sizeof line, "f %u %u %u\n", a + 1, b + 1, c + 1);
    text += line;
  }
  return text;
}

class Precompute : public ::testing::Test {
 protected:
  PrecomputeOptions options_for(const IndexedMesh& mesh) {
    PrecomputeOptions options;
    options.input = directory_.write("in.obj", as_bytes(obj_text(mesh)));
    options.output = directory_ / "out.pmesh";
    options.overwrite = Overwrite::yes;
    return options;
  }

  TemporaryDirectory directory_;
};

TEST_F(Precompute, TheFileHasExactlyTheInputsQuantisedTriangles) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    const PrecomputeOptions options = options_for(shape.mesh);
    const auto report = precompute(options, kSilent);
    ASSERT_TRUE(report.ok()) << shape.name << ": " << report.error().message;
    const auto verified = verify_file(options.output);
    ASSERT_TRUE(verified.ok()) << verified.error().message;
    const LatticeMesh expected{quantise(shape.mesh.positions, verified->index.header.lattice),
                               shape.mesh.triangles};
    EXPECT_TRUE(same_triangles(verified->full, expected)) << shape.name;
  }
}

TEST_F(Precompute, TakesEveryNonManifoldShape) {
  for (const shapes::Shape& shape : shapes::non_manifolds()) {
    const PrecomputeOptions options = options_for(shape.mesh);
    const auto report = precompute(options, kSilent);
    ASSERT_TRUE(report.ok()) << shape.name << ": " << report.error().message;
    EXPECT_EQ(report->faces,
              shape.mesh.triangles.size() - report->cleaned.degenerate - report->cleaned.duplicate);
    EXPECT_TRUE(verify_file(options.output).ok()) << shape.name;
  }
}

TEST_F(Precompute, GivesTheSameBytesForAnyNumberOfThreads) {
  PrecomputeOptions options = options_for(shapes::bumped(shapes::genus(20), 0.3));
  std::vector<Bytes> files;
  for (const unsigned threads : {1u, 2u, 5u}) {
    options.threads = threads;
    ASSERT_TRUE(precompute(options, kSilent).ok());
    files.push_back(*read_file(options.output));
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(files[0], files[2]);
}

TEST_F(Precompute, GoesThroughItsPhasesInOrder) {
  std::vector<PrecomputePhase> phases;
  const auto report =
      precompute(options_for(shapes::icosphere(3)), [&](PrecomputePhase phase, double) {
        if (phases.empty() || phases.back() != phase) phases.push_back(phase);
      });
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(phases,
            (std::vector{PrecomputePhase::import, PrecomputePhase::clean, PrecomputePhase::decimate,
                         PrecomputePhase::encode, PrecomputePhase::measure, PrecomputePhase::write,
                         PrecomputePhase::done}));
}

void expect_errors_that_no_meter_exceeds(const IndexedMesh& mesh,
                                         const PrecomputeOptions& options) {
  ASSERT_TRUE(precompute(options, kSilent).ok());
  const Result<PmFile> opened = PmFile::open(options.output);
  ASSERT_TRUE(opened.ok());
  const PmFile& file = *opened;
  ASSERT_TRUE(file.index().header.errors_measured);
  ASSERT_GT(file.index().chunks.size(), 2u);
  for (std::size_t c = 0; c < file.index().chunks.size(); ++c) {
    const LatticeMesh lod = file.decode(c + 1)->snapshot();
    IndexedMesh exported{{}, lod.triangles};
    for (const Vec3i p : lod.positions) {
      exported.positions.push_back(file.index().header.lattice.position(p));
    }
    const Comparison seen = *compare_surfaces(mesh, exported, {.samples = 200'000, .seed = 3});
    const ChunkRow& row = file.index().chunks[c];
    EXPECT_GE(row.max_error, seen.max()) << c;
    EXPECT_LE(row.max_error, 1.25 * seen.max()) << c;
    EXPECT_NEAR(row.rms_error, seen.rms(), 0.05 * seen.rms()) << c;
  }
}

TEST_F(Precompute, TheIndexHoldsErrorsThatNoMeterExceeds) {
  const IndexedMesh mesh = shapes::bumped(shapes::icosphere(5), 0.02);
  expect_errors_that_no_meter_exceeds(mesh, options_for(mesh));
}

TEST_F(Precompute, TheErrorsOfComponentsThatArriveCountTheirAbsence) {
  IndexedMesh mesh = shapes::components(3000);
  mesh = shapes::joined(std::move(mesh),
                        shapes::moved(shapes::bumped(shapes::icosphere(5), 0.1), {-3, 0, 0}));
  expect_errors_that_no_meter_exceeds(mesh, options_for(mesh));
}

TEST_F(Precompute, LeavesErrorsUnmeasuredIfAskedTo) {
  PrecomputeOptions options = options_for(shapes::icosphere(3));
  options.measure = false;
  ASSERT_TRUE(precompute(options, kSilent).ok());
  EXPECT_FALSE(PmFile::open(options.output)->index().header.errors_measured);
  EXPECT_TRUE(verify_file(options.output).ok());
}

TEST_F(Precompute, DoesNotMeasureAroundAHubAndSaysSo) {
  const PrecomputeOptions options = options_for(shapes::hub(5000));
  const auto report = precompute(options, kSilent);
  ASSERT_TRUE(report.ok());
  EXPECT_FALSE(report->measured);
  EXPECT_EQ(report->largest_valence, 5000u);
  EXPECT_FALSE(PmFile::open(options.output)->index().header.errors_measured);
}

TEST_F(Precompute, EveryMetricGivesAFileWithTheInputsTriangles) {
  const IndexedMesh mesh = shapes::bumped(shapes::grid(24, 24), 0.03);
  for (const MetricRow& row : metric_table()) {
    PrecomputeOptions options = options_for(mesh);
    options.metric = row.name;
    ASSERT_TRUE(precompute(options, kSilent).ok()) << row.name;
    const auto verified = verify_file(options.output);
    ASSERT_TRUE(verified.ok()) << row.name << ": " << verified.error().message;
    EXPECT_EQ(verified->index.header.metric, row.name);
    const Lattice& lattice = verified->index.header.lattice;
    EXPECT_TRUE(same_triangles(verified->full, {quantise(mesh.positions, lattice), mesh.triangles}))
        << row.name;
  }
}

TEST_F(Precompute, KeepsAnExistingFileUnlessToldOtherwise) {
  PrecomputeOptions options = options_for(shapes::icosphere(2));
  options.overwrite = Overwrite::no;
  directory_.write("out.pmesh", as_bytes("mine"));
  const auto report = precompute(options, kSilent);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(read_file(options.output)->size(), 4u);
}

TEST_F(Precompute, LeavesNothingBehindOnBadInput) {
  PrecomputeOptions options = options_for(shapes::icosphere(2));
  options.input = directory_.write("bad.obj", as_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"));
  const auto report = precompute(options, kSilent);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().code, ErrorCode::bad_input);
  EXPECT_EQ(report.error().message.rfind(options.input + ": line 4: ", 0), 0u)
      << report.error().message;
  for (const auto& entry : std::filesystem::directory_iterator(directory_ / "")) {
    EXPECT_EQ(entry.path().extension(), ".obj") << entry.path();
  }
}

TEST_F(Precompute, RefusesAMeshWithoutAnyFace) {
  PrecomputeOptions options = options_for(shapes::icosphere(1));
  options.input = directory_.write("flat.obj", as_bytes("v 0 0 0\nv 1 0 0\nf 1 2 1\n"));
  const auto report = precompute(options, kSilent);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().message, options.input + ": no face with three distinct vertices");
}

TEST_F(Precompute, RefusesAMetricItDoesNotKnow) {
  PrecomputeOptions options = options_for(shapes::icosphere(1));
  options.metric = "beauty";
  const auto report = precompute(options, kSilent);
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.error().code, ErrorCode::usage);
}

// The bunny in UTM-like coordinates keeps every face, and every position to within a lattice step.
TEST_F(Precompute, TheBunnyMovedByFiveMillionMetresLosesNothing) {
  PMESH_NEED_REAL_MESH(path, "bunny.obj");
  IndexedMesh bunny = import_mesh(path)->mesh;
  PrecomputeOptions options = options_for(shapes::moved(bunny, {5e6, 5e6, 5e6}));
  const auto moved = precompute(options, kSilent);
  ASSERT_TRUE(moved.ok()) << moved.error().message;
  EXPECT_EQ(moved->faces, 69'451u);
  EXPECT_EQ(moved->vertices, 34'834u);
  EXPECT_LE(moved->base_faces, 200u);
  const auto verified = verify_file(options.output);
  ASSERT_TRUE(verified.ok());
  const IndexedMesh shifted = import_mesh(options.input)->mesh;
  const LatticeMesh expected{quantise(shifted.positions, verified->index.header.lattice),
                             shifted.triangles};
  EXPECT_TRUE(same_triangles(verified->full, expected));
  EXPECT_LT(verified->index.header.lattice.step, 5e-5);
}

}  // namespace
}  // namespace pmesh
