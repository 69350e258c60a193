// The whole route on real scans, CAD and broken meshes: what comes back is what went in, and every
// chunk end on the way is a manifold.
#include "tests/fixtures/real_meshes.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "core/io/import.h"
#include "core/pm/pm_file.h"
#include "core/pm/verify.h"
#include "core/precompute/precompute.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh {
namespace {

struct RealMesh {
  const char* name;
  std::uint64_t faces;       // after cleaning
  std::uint64_t base_faces;  // at most
};

class RealMeshes : public ::testing::TestWithParam<RealMesh> {
 protected:
  // Skips the test if the mesh is not there.
  void SetUp() override {
    PMESH_NEED_REAL_MESH(path, GetParam().name);
    options_.input = path;
    options_.output = directory_ / "mesh.pmesh";
    options_.overwrite = Overwrite::yes;
    const auto made = precompute(options_, [](PrecomputePhase, double) {});
    ASSERT_TRUE(made.ok()) << made.error().message;
    report_ = *made;
  }

  TemporaryDirectory directory_;
  PrecomputeOptions options_;
  PrecomputeReport report_;
};

TEST_P(RealMeshes, KeepEveryTriangleAndReachTheirBase) {
  EXPECT_EQ(report_.faces, GetParam().faces);
  EXPECT_LE(report_.base_faces, GetParam().base_faces);
  const auto verified = verify_file(options_.output);
  ASSERT_TRUE(verified.ok()) << verified.error().message;
  const CleanedMesh cleaned = clean(*import_mesh(options_.input));
  const LatticeMesh expected{quantise(cleaned.mesh.positions, report_.lattice),
                             cleaned.mesh.triangles};
  EXPECT_TRUE(same_triangles(verified->full, expected));
}

TEST_P(RealMeshes, AreManifoldAtEveryChunkEndReachedFromEitherSide) {
  const auto file = PmFile::open(options_.output);
  ASSERT_TRUE(file.ok());
  const FileIndex& index = file->index();
  auto finest = file->decode(index.chunks.size());
  ASSERT_TRUE(finest.ok());
  for (std::size_t chunks = index.chunks.size() + 1; chunks-- > 0;) {
    finest->set_vertices(index.vertices_after(chunks));
    ASSERT_EQ(finest->face_count(), index.faces_after(chunks));
    const Status valid = finest->connectivity().validate();
    ASSERT_TRUE(valid.ok()) << "chunk " << chunks << ": " << valid.error().message;
    const auto refined = file->decode(chunks);
    ASSERT_TRUE(refined.ok());
    ASSERT_EQ(refined->snapshot().triangles, finest->snapshot().triangles);
    ASSERT_EQ(refined->snapshot().positions, finest->snapshot().positions);
  }
}

TEST_P(RealMeshes, GiveTheSameFileForAnyNumberOfThreads) {
  options_.threads = 3;
  const auto again = precompute(options_, [](PrecomputePhase, double) {});
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->hash, report_.hash);
}

INSTANTIATE_TEST_SUITE_P(All, RealMeshes,
                         ::testing::Values(RealMesh{"bunny.obj", 69'451, 200},
                                           RealMesh{"horse.ply", 96'966, 200},
                                           RealMesh{"armadillo_52k.off", 52'000, 200},
                                           RealMesh{"motorbike.obj", 331'653, 1'400},
                                           RealMesh{"bunny_soup.stl", 69'451, 200},
                                           RealMesh{"rangemap_lato000.ply", 86'766, 200},
                                           RealMesh{"happy_vrip_q14.ply", 1'087'716, 1'500},
                                           RealMesh{"dragon_vrip.ply", 871'414, 750}),
                         [](const auto& tested) {
                           std::string name = tested.param.name;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return c == '.'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace pmesh
