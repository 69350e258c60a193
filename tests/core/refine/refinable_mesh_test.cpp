#include "core/refine/refinable_mesh.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fixtures/pm_files.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

RefinableMesh decoded(const EncodedShape& shape) {
  StreamDecoder decoder(decode_base);
  EXPECT_TRUE(decoder.feed(shape.file).ok()) << shape.name;
  return std::move(decoder.mesh());
}

bool same(const LatticeMesh& a, const LatticeMesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

TEST(RefinableMesh, RefiningAndCoarseningToTheSameLodGiveTheSameIdsAndPositions) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    RefinableMesh up = decoded(shape), down = decoded(shape);
    up.set_steps(0);
    const std::uint32_t step = std::max(1u, up.known_steps() / 37);
    for (std::uint32_t k = 0; k < up.known_steps(); k += step) {
      up.set_steps(k);
      down.set_finest();
      down.set_steps(k);
      ASSERT_TRUE(same(up.snapshot(), down.snapshot())) << shape.name << " at " << k;
    }
  }
}

TEST(RefinableMesh, EveryLodIsAManifold) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    RefinableMesh mesh = decoded(shape);
    const std::uint32_t step = std::max(1u, mesh.known_steps() / 19);
    for (std::uint32_t k = 0; k <= mesh.known_steps(); k += step) {
      mesh.set_steps(k);
      const Status valid = mesh.connectivity().validate();
      ASSERT_TRUE(valid.ok()) << shape.name << " at " << k << ": " << valid.error().message;
    }
  }
}

TEST(RefinableMesh, AFaceWishGivesTheLargestLodWithAtMostThatManyFaces) {
  for (const EncodedShape& shape : encoded_manifolds()) {
    RefinableMesh mesh = decoded(shape), next = mesh;
    mesh.set_steps(0);
    const std::uint32_t base = mesh.face_count();
    for (std::uint32_t faces = base; faces <= shape.quantised.triangles.size(); faces += 13) {
      mesh.set_faces(faces);
      ASSERT_LE(mesh.face_count(), faces) << shape.name;
      if (mesh.is_finest()) continue;
      next.set_steps(mesh.applied_steps() + 1);
      ASSERT_GT(next.face_count(), faces) << shape.name;
    }
  }
}

TEST(RefinableMesh, AWishBelowTheBaseGivesTheBase) {
  RefinableMesh mesh = decoded(encode_shape("ball", shapes::icosphere(3)));
  mesh.set_faces(1);
  EXPECT_EQ(mesh.applied_steps(), 0u);
  mesh.set_finest();
  mesh.set_vertices(1);
  EXPECT_EQ(mesh.applied_steps(), 0u);
}

TEST(RefinableMesh, AVertexWishIsMetExactly) {
  RefinableMesh mesh = decoded(encode_shape("ball", shapes::icosphere(3)));
  for (const std::uint32_t vertices : {20u, 100u, 641u}) {
    mesh.set_vertices(vertices);
    EXPECT_EQ(mesh.vertex_count(), vertices);
  }
  mesh.set_vertices(1u << 30);
  EXPECT_TRUE(mesh.is_finest());
}

// A tetrahedron, whose vertex 0 is split twice and moves the second time.
RefinableMesh moved_tetrahedron() {
  RefinableMesh mesh = *RefinableMesh::from_base(
      {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}});
  EXPECT_TRUE(mesh.append({{HalfEdgeId(0), 1, SplitKind::interior}, {1, 1, 1}}).ok());
  EXPECT_TRUE(mesh.append({{HalfEdgeId(3), 1, SplitKind::interior}, {2, 2, 2}, {5, 0, 7}}).ok());
  return mesh;
}

TEST(RefinableMesh, ARelocationIsUndoneWithItsSplit) {
  RefinableMesh mesh = moved_tetrahedron();
  EXPECT_EQ(mesh.positions()[0], (Vec3i{5, 0, 7}));
  for (const std::uint32_t splits : {1u, 0u, 1u}) {
    mesh.set_steps(splits);
    EXPECT_EQ(mesh.positions()[0], (Vec3i{0, 0, 0}));
  }
  mesh.set_finest();
  EXPECT_EQ(mesh.positions()[0], (Vec3i{5, 0, 7}));
}

TEST(RefinableMesh, AForgottenRelocationMayBeReplacedByAnother) {
  RefinableMesh mesh = moved_tetrahedron();
  mesh.set_steps(1);
  mesh.forget_finer();
  ASSERT_TRUE(mesh.append({{HalfEdgeId(3), 1, SplitKind::interior}, {3, 3, 3}, {8, 8, 8}}).ok());
  EXPECT_EQ(mesh.positions()[0], (Vec3i{8, 8, 8}));
  EXPECT_EQ(mesh.positions()[5], (Vec3i{3, 3, 3}));
  mesh.set_steps(0);
  EXPECT_EQ(mesh.positions()[0], (Vec3i{0, 0, 0}));
}

TEST(RefinableMesh, RefusesAnImpossibleSplitAndStaysAsItWas) {
  RefinableMesh mesh = decoded(encode_shape("ball", shapes::icosphere(2)));
  const LatticeMesh before = mesh.snapshot();
  EXPECT_FALSE(mesh.append({{HalfEdgeId(0), 0, SplitKind::interior}, {1, 2, 3}}).ok());
  EXPECT_FALSE(mesh.append({{HalfEdgeId(0), 200, SplitKind::interior}, {1, 2, 3}}).ok());
  EXPECT_FALSE(mesh.append({{HalfEdgeId(0), 1, SplitKind::border_last}, {1, 2, 3}}).ok());
  EXPECT_FALSE(mesh.append({{HalfEdgeId(1u << 30), 1, SplitKind::interior}, {1, 2, 3}}).ok());
  EXPECT_TRUE(same(mesh.snapshot(), before));
}

TEST(RefinableMesh, RefusesABaseThatIsNoManifold) {
  const LatticeMesh two_fans{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0, 2, 0}},
                             {{0, 1, 2}, {0, 3, 4}}};
  const auto mesh = RefinableMesh::from_base(two_fans);
  ASSERT_FALSE(mesh.ok());
  EXPECT_EQ(mesh.error().message, "base mesh: vertex 0 has more than one fan of faces");
}

}  // namespace
}  // namespace pmesh
