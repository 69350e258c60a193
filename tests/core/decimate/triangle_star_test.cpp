#include "core/decimate/triangle_star.h"

#include <gtest/gtest.h>

#include "core/decimate/face_turn.h"
#include "tests/core/decimate/triangle_shapes.h"

namespace pmesh {
namespace {

class TriangleStarOf : public testing::TestWithParam<shapes::Shape> {};

TEST_P(TriangleStarOf, HasTheApexesAcrossFromTheCorners) {
  for_each_star(GetParam().mesh, [&](const WorkingMesh& work, FaceId, const TriangleStar& star) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexId from = star.corners[(k + 1) % 3], to = star.corners[(k + 2) % 3];
      const VertexId apex = work.mesh().apex(work.mesh().find_edge(to, from));
      const Vec3d in_place = star.centroid + 1 / work.frame().scale * star.apexes[k];
      EXPECT_LT(length(in_place - work.position(apex)), 1e-12);
    }
  });
}

TEST_P(TriangleStarOf, LinkConditionsHoldIfTwoLegalCollapsesMergeTheCorners) {
  for_each_star(GetParam().mesh, [](const WorkingMesh& work, FaceId, const TriangleStar& star) {
    std::array<std::uint32_t, 3> order{0, 1, 2};
    bool any = false;
    do {
      any |= merged(work.mesh(), star, order).has_value();
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(link_conditions_hold(star), any);
    EXPECT_EQ(link_conditions_hold(star), merged(work.mesh(), star, star.order).has_value());
  });
}

TEST_P(TriangleStarOf, CollapseTakesFourFacesAndTwoVertices) {
  for_each_star(GetParam().mesh, [](const WorkingMesh& work, FaceId, const TriangleStar& star) {
    if (!link_conditions_hold(star)) return;
    const HalfEdgeMesh after = *merged(work.mesh(), star, star.order);
    EXPECT_TRUE(after.validate());
    EXPECT_EQ(after.live_faces() + 4, work.mesh().live_faces());
    EXPECT_EQ(after.live_vertices() + 2, work.mesh().live_vertices());
  });
}

TEST_P(TriangleStarOf, NoticesApexesLeftWithThreeFaces) {
  for_each_star(GetParam().mesh, [](const WorkingMesh& work, FaceId f, const TriangleStar&) {
    bool any = false;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexId apex =
          work.mesh().apex(work.mesh().twin(HalfEdgeId(3 * f.value + (k + 1) % 3)));
      any |= !work.mesh().is_border(apex) && valence(work.mesh(), apex) == 4;
    }
    EXPECT_EQ(leaves_valence_three(work.mesh(), f), any);
  });
}

// Whether a face that is in `before` and in `after` has turned by more than 90 degrees, or has lost
// its area.
bool has_turned(const HalfEdgeMesh& before, std::span<const Vec3d> old_positions,
                const HalfEdgeMesh& after, std::span<const Vec3d> positions) {
  struct Normal {
    Vec3d doubled_area;
    bool has_area;
  };
  const auto normal_of = [](const HalfEdgeMesh& mesh, std::span<const Vec3d> at, std::uint32_t f) {
    const auto corners = mesh.corners().subspan(std::size_t{3} * f, 3);
    const Vec3d a = at[corners[0].value], b = at[corners[1].value], c = at[corners[2].value];
    const Vec3d n = cross(b - a, c - a);
    return Normal{n, has_area(n, b - a, c - a)};
  };
  for (std::uint32_t f = 0; f < before.face_slots(); ++f) {
    if (!before.is_live(FaceId(f)) || !after.is_live(FaceId(f))) continue;
    const Normal was = normal_of(before, old_positions, f), is = normal_of(after, positions, f);
    if (was.has_area && (!is.has_area || dot(was.doubled_area, is.doubled_area) < 0)) return true;
  }
  return false;
}

TEST_P(TriangleStarOf, NoticesFacesThatEitherCollapseTurnsOver) {
  for_each_star(GetParam().mesh, [](const WorkingMesh& work, FaceId, const TriangleStar& star) {
    if (!link_conditions_hold(star)) return;
    std::vector<Vec3d> positions = work.positions();
    HalfEdgeMesh mesh = work.mesh();
    bool any = false;
    for (const std::uint32_t corner : {star.order[0], star.order[1]}) {
      const HalfEdgeMesh before = mesh;
      const std::vector<Vec3d> old_positions = positions;
      const VertexId removed = star.corners[corner], kept = star.corners[star.order[2]];
      mesh.collapse(removed, mesh.find_edge(removed, kept));
      positions[kept.value] = star.centroid;
      any |= has_turned(before, old_positions, mesh, positions);
    }
    EXPECT_EQ(turns_faces(star, 0), any);
  });
}

INSTANTIATE_TEST_SUITE_P(Shapes, TriangleStarOf, testing::ValuesIn(triangle_shapes()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(TriangleStar, IsNotOfATriangleWithABorderCorner) {
  const IndexedMesh mesh = shapes::grid(5, 5);
  std::size_t stars = 0;
  for_each_star(mesh, [&](const WorkingMesh& work, FaceId, const TriangleStar& star) {
    for (const VertexId v : star.corners) EXPECT_FALSE(work.mesh().is_border(v));
    ++stars;
  });
  EXPECT_EQ(stars, std::size_t{3 * 3 * 2});
}

TEST(TriangleStar, IsNotOfATriangleAtAHub) {
  const IndexedMesh cap = shapes::hub(TriangleStar::kMaxFaces + 1);
  IndexedMesh closed = cap;  // a second hub below the rim
  const auto below = static_cast<std::uint32_t>(closed.positions.size());
  closed.positions.push_back({0, 0, -0.2});
  for (const auto& [a, b, c] : cap.triangles) closed.triangles.push_back({below, c, b});
  for_each_star(closed, [](const WorkingMesh&, FaceId, const TriangleStar&) { ADD_FAILURE(); });
}

TEST(TriangleStar, FacesOfAFlatGridDoNotTurn) {
  std::size_t stars = 0;
  for_each_star(shapes::grid(5, 5), [&](const WorkingMesh&, FaceId, const TriangleStar& star) {
    EXPECT_FALSE(turns_faces(star, 0.999999));
    ++stars;
  });
  EXPECT_GT(stars, 0u);
}

}  // namespace
}  // namespace pmesh
