#include "core/pm/base_codec.h"

#include <gtest/gtest.h>

#include "core/mesh/half_edge_mesh.h"
#include "core/precompute/quantise.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

LatticeMesh on_lattice(const IndexedMesh& mesh, int bits) {
  return {quantise(mesh.positions, *make_lattice(mesh.positions, bits)), mesh.triangles};
}

MeshCounts counts_of(const LatticeMesh& mesh) {
  return {mesh.positions.size(), mesh.triangles.size()};
}

TEST(BaseCodec, KeepsEveryTriangleOfEveryManifold) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    const LatticeMesh mesh = on_lattice(shape.mesh, 14);
    const auto coded = encode_base(mesh);
    ASSERT_TRUE(coded.ok()) << shape.name << ": " << coded.error().message;
    const auto decoded = decode_base(coded->bytes, counts_of(mesh));
    ASSERT_TRUE(decoded.ok()) << shape.name << ": " << decoded.error().message;
    EXPECT_TRUE(same_triangles(mesh, *decoded)) << shape.name;
    EXPECT_EQ(decoded->positions, coded->decoded.positions);
    EXPECT_EQ(decoded->triangles, coded->decoded.triangles);
  }
}

TEST(BaseCodec, TellsWhereEachVertexWent) {
  // At 4 bits most vertices share their position: the order cannot be told from positions.
  const LatticeMesh mesh = on_lattice(shapes::icosphere(3), 4);
  const auto coded = encode_base(mesh);
  ASSERT_TRUE(coded.ok());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(coded->decoded.positions[coded->decoded_vertex[v]], mesh.positions[v]);
  }
  auto sorted = coded->decoded_vertex;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

TEST(BaseCodec, UsesEdgeBreakerBecauseItsOrderIsFound) {
  constexpr std::size_t kMethodOffset = 8;
  for (const shapes::Shape& shape : shapes::manifolds()) {
    const auto coded = encode_base(on_lattice(shape.mesh, 12));
    ASSERT_TRUE(coded.ok());
    EXPECT_EQ(coded->bytes[kMethodOffset], 1) << shape.name;
  }
}

TEST(BaseCodec, RefusesCountsOtherThanTheHeaders) {
  const LatticeMesh mesh = on_lattice(shapes::icosphere(2), 10);
  const auto coded = encode_base(mesh);
  MeshCounts counts = counts_of(mesh);
  --counts.faces;
  EXPECT_EQ(decode_base(coded->bytes, counts).error().message,
            "Draco's counts differ from the header's");
}

TEST(BaseCodec, RefusesWhatIsNotDraco) {
  const MeshCounts counts = counts_of(on_lattice(shapes::tetrahedron(), 10));
  EXPECT_EQ(decode_base(as_bytes("nonsense"), counts).error().message, "not a Draco 2.2 mesh");
  EXPECT_FALSE(decode_base({}, counts).ok());
}

TEST(BaseCodec, AnswersEveryTruncationWithAnError) {
  const LatticeMesh mesh = on_lattice(shapes::icosphere(2), 10);
  const auto coded = encode_base(mesh);
  for (std::size_t n = 0; n < coded->bytes.size(); ++n) {
    const Bytes cut(coded->bytes.begin(), coded->bytes.begin() + static_cast<std::ptrdiff_t>(n));
    const auto decoded = decode_base(cut, counts_of(mesh));
    EXPECT_TRUE(!decoded.ok() || decoded->triangles.size() == mesh.triangles.size()) << n;
  }
}

}  // namespace
}  // namespace pmesh
