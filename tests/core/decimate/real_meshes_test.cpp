// What real scans must come down to.
#include "tests/fixtures/real_meshes.h"

#include <gtest/gtest.h>

#include "core/decimate/decimate.h"
#include "core/io/clean.h"
#include "core/io/import.h"
#include "tests/core/decimate/rings.h"

namespace pmesh {
namespace {

struct Expectation {
  std::string file;
  std::uint32_t most_faces;  ///< Of the base, if 200 are asked for.
};

class DecimateRealMesh : public testing::TestWithParam<Expectation> {};

TEST_P(DecimateRealMesh, ComesDownToAFewFaces) {
  PMESH_NEED_REAL_MESH(path, GetParam().file);
  Result<ImportedMesh> imported = import_mesh(path);
  ASSERT_TRUE(imported) << imported.error().message;
  const IndexedMesh mesh = clean(std::move(*imported)).mesh;
  const Decimation result = decimate(half_edges(mesh), mesh.positions);
  EXPECT_TRUE(result.mesh.validate());
  EXPECT_LE(result.report.faces, GetParam().most_faces);
}

// The dragon's genus is 55, the happy Buddha's 104.
INSTANTIATE_TEST_SUITE_P(Meshes, DecimateRealMesh,
                         testing::Values(Expectation{"bunny.obj", 200},
                                         Expectation{"horse.ply", 200},
                                         Expectation{"dragon_vrip.ply", 750},
                                         Expectation{"happy_vrip_q14.ply", 1500}));

}  // namespace
}  // namespace pmesh
