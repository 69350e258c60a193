#include "tests/fixtures/real_meshes.h"

#include <filesystem>

#include "tests/core/clean/cleaning.h"

namespace pmesh {
namespace {

ImportedMesh imported(const std::string& path) {
  Result<ImportedMesh> mesh = import_mesh(path);
  EXPECT_TRUE(mesh) << path << ": " << mesh.error().message;
  return mesh ? std::move(mesh).value() : ImportedMesh{};
}

CleanedMesh cleaned_file(const std::string& path) {
  const ImportedMesh mesh = imported(path);
  CleanedMesh result = clean(mesh);
  expect_sound(mesh.mesh, result);
  return result;
}

TEST(CleanRealMesh, DragonBecomesOneClosedPiece) {
  PMESH_NEED_REAL_MESH(path, "dragon_vrip.ply");
  const CleanedMesh dragon = cleaned_file(path);
  EXPECT_EQ(dragon.mesh.triangles.size(), 871414u);
  // 2,100 vertices share their position with a lower one, but 54 of them are interior.
  EXPECT_EQ(dragon.report.welded, 2046u);
  EXPECT_EQ(dragon.mesh.positions.size(), 435599u);
  EXPECT_EQ(components(dragon.mesh), 1u);
  EXPECT_EQ(border_edges(dragon.mesh), 0u);
}

TEST(CleanRealMesh, HappyKeepsItsZeroAreaFaces) {
  PMESH_NEED_REAL_MESH(path, "happy_vrip_q14.ply");
  const CleanedMesh happy = cleaned_file(path);
  EXPECT_EQ(happy.mesh.triangles.size(), 1087716u);
  EXPECT_EQ(happy.mesh.positions.size(), 543652u);
  EXPECT_EQ(happy.report.vertices_added + happy.report.welded, 0u);
}

TEST(CleanRealMesh, MotorbikeKeepsItsBackSides) {
  PMESH_NEED_REAL_MESH(path, "motorbike.obj");
  const CleanedMesh motorbike = cleaned_file(path);
  EXPECT_EQ(motorbike.report.opposite_pairs, 67326u);
  EXPECT_EQ(motorbike.mesh.triangles.size(), 331653u);
}

TEST(CleanRealMesh, BunnySoupIsWelded) {
  PMESH_NEED_REAL_MESH(path, "bunny_soup.stl");
  const CleanedMesh bunny = cleaned_file(path);
  EXPECT_EQ(bunny.mesh.positions.size(), 34834u);
  EXPECT_EQ(bunny.mesh.triangles.size(), 69451u);
  EXPECT_EQ(components(bunny.mesh), 1u);
  EXPECT_EQ(border_edges(bunny.mesh), 223u);
}

TEST(CleanRealMesh, BunnyFarFromTheOriginLosesNothing) {
  PMESH_NEED_REAL_MESH(path, "bunny.obj");
  ImportedMesh bunny = imported(path);
  const CleanedMesh near = clean(bunny);
  bunny.mesh = shapes::moved(std::move(bunny.mesh), {5e6, 5e6, 5e6});
  const CleanedMesh far = clean(bunny);
  expect_sound(bunny.mesh, far);
  EXPECT_EQ(far.mesh.triangles, near.mesh.triangles);
  EXPECT_EQ(far.mesh.positions.size(), 34834u);
}

TEST(CleanRealMesh, CountsWhatIsKnownOfDirtyMeshes) {
  PMESH_NEED_REAL_MESH(male, "male02.obj");
  PMESH_NEED_REAL_MESH(range_map, "rangemap_lato000.ply");
  const CleanReport male_report = cleaned_file(male).report;
  EXPECT_EQ(male_report.nonmanifold_edges_cut, 11u);
  EXPECT_EQ(male_report.winding_edges_cut, 10u);
  const CleanReport map_report = cleaned_file(range_map).report;
  EXPECT_EQ(map_report.unreferenced, 192u);
  EXPECT_EQ(map_report.nonmanifold_vertices_cut, 2u);
}

class CleanRealMeshes : public testing::TestWithParam<const char*> {};

TEST_P(CleanRealMeshes, BecomeManifolds) {
  PMESH_NEED_REAL_MESH(path, GetParam());
  cleaned_file(path);
}

INSTANTIATE_TEST_SUITE_P(, CleanRealMeshes,
                         testing::Values("dragon_vrip_res2.ply", "dragon_vrip_res3.ply",
                                         "beast.obj", "teapot.obj", "spider.obj", "cow.obj",
                                         "walthead.obj", "rangemap_lato180.ply"));

TEST(CleanRealMesh, EveryNastyFileThatParsesBecomesAManifold) {
  PMESH_NEED_REAL_MESH(folder, "nasty");
  int parsed = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || !mesh_format_of(entry.path().string())) continue;
    const Result<ImportedMesh> mesh = import_mesh(entry.path().string());
    if (!mesh) continue;
    SCOPED_TRACE(entry.path().string());
    expect_sound(mesh->mesh, clean(*mesh));
    ++parsed;
  }
  EXPECT_GT(parsed, 200);
}

}  // namespace
}  // namespace pmesh
