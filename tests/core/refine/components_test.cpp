// Arrivals: components that come into a progressive mesh, and leave it, as one step.
#include <gtest/gtest.h>

#include "core/refine/refinable_mesh.h"

namespace pmesh {
namespace {

LatticeMesh tetrahedron(std::int32_t at) {
  return {{{at, 0, 0}, {at + 9, 0, 0}, {at, 9, 0}, {at, 0, 9}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

// A triangle and a tetrahedron.
LatticeMesh two_components() {
  LatticeMesh mesh = tetrahedron(100);
  mesh.positions.insert(mesh.positions.end(), {{50, 0, 0}, {60, 0, 0}, {50, 9, 0}});
  mesh.triangles.push_back({4, 5, 6});
  return mesh;
}

bool same(const LatticeMesh& a, const LatticeMesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

// Five steps: a split, two arrivals in one, a split of the new tetrahedron, an ear on the new
// triangle, an arrival.
RefinableMesh refined(Vec3i relocation = {}) {
  RefinableMesh mesh = *RefinableMesh::from_base(tetrahedron(0));
  const HalfEdgeId in_tetrahedron(3 * 6), in_triangle(3 * 10);
  EXPECT_TRUE(mesh.append({{HalfEdgeId(0), 1, SplitKind::interior}, {1, 1, 1}}).ok());
  EXPECT_TRUE(mesh.append(two_components()).ok());
  EXPECT_TRUE(mesh.append({{in_tetrahedron, 1, SplitKind::interior}, {2, 2, 2}, relocation}).ok());
  EXPECT_TRUE(mesh.append({{in_triangle, 0, SplitKind::border_first}, {3, 3, 3}}).ok());
  EXPECT_TRUE(mesh.append(tetrahedron(200)).ok());
  return mesh;
}

TEST(Arrivals, TakeTheNextIdsInTheirOwnOrder) {
  RefinableMesh mesh = refined();
  mesh.set_steps(2);
  EXPECT_TRUE(mesh.last_is_arrival());
  const LatticeMesh lod = mesh.snapshot();
  ASSERT_EQ(lod.positions.size(), 5u + 7u);
  EXPECT_EQ(lod.positions[5], (Vec3i{100, 0, 0}));
  EXPECT_EQ(lod.positions[11], (Vec3i{50, 9, 0}));
  EXPECT_EQ(lod.triangles[6], (Triangle{5, 7, 6}));
  EXPECT_EQ(lod.triangles[10], (Triangle{9, 10, 11}));
}

TEST(Arrivals, ComeAndGoExactly) {
  for (const Vec3i relocation : {Vec3i{}, Vec3i{4, 0, 1}}) {
    RefinableMesh mesh = refined(relocation);
    std::vector<LatticeMesh> coarsened;
    for (std::uint32_t steps = mesh.known_steps() + 1; steps-- > 0;) {
      mesh.set_steps(steps);
      EXPECT_TRUE(mesh.connectivity().validate().ok()) << steps;
      coarsened.insert(coarsened.begin(), mesh.snapshot());
    }
    for (std::uint32_t steps = 0; steps <= mesh.known_steps(); ++steps) {
      mesh.set_steps(steps);
      EXPECT_TRUE(mesh.connectivity().validate().ok()) << steps;
      EXPECT_TRUE(same(mesh.snapshot(), coarsened[steps])) << steps;
    }
  }
}

TEST(Arrivals, AreTakenWholeOrNotAtAllByAWish) {
  RefinableMesh mesh = refined();
  mesh.set_faces(10);  // the arrival makes 11 of 6
  EXPECT_EQ(mesh.applied_steps(), 1u);
  mesh.set_faces(11);
  EXPECT_EQ(mesh.applied_steps(), 2u);
  mesh.set_vertices(11);  // and 12 of 5
  EXPECT_EQ(mesh.applied_steps(), 1u);
  mesh.set_vertices(12);
  EXPECT_EQ(mesh.applied_steps(), 2u);
  mesh.set_vertices(~std::uint64_t{0});
  EXPECT_TRUE(mesh.is_finest());
}

TEST(Arrivals, OnceForgottenMayBeReplacedByOthers) {
  RefinableMesh mesh = refined();
  mesh.set_steps(1);
  mesh.forget_finer();
  EXPECT_EQ(mesh.known_vertices(), 5u);
  ASSERT_TRUE(mesh.append(tetrahedron(300)).ok());
  const LatticeMesh finest = mesh.snapshot();
  EXPECT_EQ(finest.positions[5], (Vec3i{300, 0, 0}));
  mesh.set_steps(0);
  mesh.set_finest();
  EXPECT_TRUE(same(mesh.snapshot(), finest));
}

TEST(Arrivals, AreRefusedIfTheyAreNoManifold) {
  RefinableMesh mesh = refined();
  const LatticeMesh before = mesh.snapshot();
  EXPECT_FALSE(mesh.append(LatticeMesh{}).ok());
  EXPECT_FALSE(mesh.append(LatticeMesh{{{0, 0, 0}}, {}}).ok());
  LatticeMesh unused_vertex = tetrahedron(0);
  unused_vertex.positions.push_back({1, 1, 1});
  EXPECT_FALSE(mesh.append(unused_vertex).ok());
  LatticeMesh out_of_range = tetrahedron(0);
  out_of_range.triangles[0][0] = 4;
  const Status refused = mesh.append(out_of_range);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "new components: face 0 has a vertex index out of range");
  EXPECT_EQ(mesh.known_steps(), 5u);
  EXPECT_TRUE(same(mesh.snapshot(), before));
}

TEST(Arrivals, RoomMayBeTakenAtOnce) {
  RefinableMesh mesh = *RefinableMesh::from_base(tetrahedron(0));
  mesh.reserve(100, 200);
  ASSERT_TRUE(mesh.append(two_components()).ok());
  EXPECT_TRUE(mesh.connectivity().validate().ok());
}

}  // namespace
}  // namespace pmesh
