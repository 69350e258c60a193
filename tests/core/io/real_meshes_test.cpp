// Real meshes, from the folder that the environment variable PMESH_TEST_MESHES names.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/io/import.h"

namespace pmesh {
namespace {

namespace fs = std::filesystem;

class RealMeshes : public testing::Test {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("PMESH_TEST_MESHES");
    if (folder == nullptr || !fs::is_directory(folder)) {
      GTEST_SKIP() << "PMESH_TEST_MESHES names no folder of meshes";
    }
    folder_ = folder;
  }

  fs::path folder_;
};

struct KnownCounts {
  const char* file;
  std::size_t vertices;
  std::size_t faces;
  bool is_soup = false;
  std::uint64_t polygons = 0;
};

constexpr KnownCounts kKnown[] = {{"happy_vrip_q14.ply", 543652, 1087716},
                                  {"dragon_vrip.ply", 437645, 871414},
                                  {"ct_engine_587k.ply", 294141, 586874},
                                  {"motorbike.obj", 132871, 331653},
                                  {"horse.ply", 48485, 96966},
                                  {"rangemap_lato000.ply", 44461, 86766},
                                  {"bunny.obj", 35947, 69451},
                                  {"bunny_soup.stl", 208353, 69451, true},
                                  {"bunny_zipper.ply", 35947, 69451},
                                  {"beast.obj", 32311, 64618, false, 32240},
                                  {"armadillo_52k.off", 26002, 52000},
                                  {"gargo.ply", 25002, 50000},
                                  {"fandisk.obj", 6475, 12946},
                                  {"male02.obj", 2746, 5004},
                                  {"spider.obj", 762, 1368}};

TEST_F(RealMeshes, HaveTheirKnownCounts) {
  for (const KnownCounts& known : kKnown) {
    const Result<ImportedMesh> imported = import_mesh((folder_ / known.file).string());
    ASSERT_TRUE(imported.ok()) << imported.error().message;
    EXPECT_EQ(imported->mesh.positions.size(), known.vertices) << known.file;
    EXPECT_EQ(imported->mesh.triangles.size(), known.faces) << known.file;
    EXPECT_EQ(imported->is_soup, known.is_soup) << known.file;
    EXPECT_EQ(imported->polygons, known.polygons) << known.file;
  }
}

TEST_F(RealMeshes, AllAreParsedOrRefusedWithAMessage) {
  if (!fs::is_directory(folder_ / "nasty"))
    GTEST_SKIP() << "no folder 'nasty' in PMESH_TEST_MESHES";
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "nasty")) {
    if (!entry.is_regular_file() || !mesh_format_of(entry.path().string())) continue;
    const Result<ImportedMesh> imported = import_mesh(entry.path().string());
    if (!imported.ok()) {
      EXPECT_EQ(imported.error().code, ErrorCode::bad_input) << imported.error().message;
      EXPECT_GT(imported.error().message.size(), entry.path().string().size() + 2);
    }
  }
}

}  // namespace
}  // namespace pmesh
