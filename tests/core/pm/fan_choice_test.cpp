#include "core/pm/fan_choice.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/pm/split_model.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

constexpr VertexId kCentre(0);

RefinableMesh disc(int faces) {
  return make_split_base("disc", shapes::hub(faces), 10, false).refinable();
}
RefinableMesh half_disc(int faces) {
  return make_split_base("half disc", shapes::border_hub(faces), 10, false).refinable();
}

TEST(VertexRing, StartsAtTheSmallestFaceOfAnInteriorVertex) {
  const RefinableMesh mesh = make_split_base("ball", shapes::icosphere(2), 10, false).refinable();
  for (VertexId v(0); v.value < mesh.vertex_count(); ++v.value) {
    VertexRing ring;
    ASSERT_TRUE(ring.gather(mesh, v));
    EXPECT_FALSE(ring.border());
    for (std::uint32_t i = 0; i < ring.faces(); ++i) {
      EXPECT_GE(ring.face(i), ring.face(0));
      EXPECT_EQ(mesh.connectivity().origin(ring.half_edge(i)), v);
      EXPECT_EQ(mesh.connectivity().rotate_ccw(ring.half_edge(i)),
                ring.half_edge((i + 1) % ring.faces()));
    }
  }
}

TEST(VertexRing, StartsAtTheBorderOfABorderVertex) {
  const RefinableMesh mesh = half_disc(5);
  VertexRing ring;
  ASSERT_TRUE(ring.gather(mesh, kCentre));
  EXPECT_TRUE(ring.border());
  EXPECT_EQ(ring.faces(), 5u);
  EXPECT_EQ(ring.half_edge(0), mesh.connectivity().outgoing(kCentre));
}

TEST(VertexRing, HoldsSixtyFourFacesAndNoMore) {
  VertexRing ring;
  EXPECT_TRUE(ring.gather(disc(64), kCentre));
  EXPECT_EQ(ring.faces(), 64u);
  EXPECT_FALSE(ring.gather(disc(65), kCentre));
  EXPECT_TRUE(ring.gather(half_disc(64), kCentre));
  EXPECT_FALSE(ring.gather(half_disc(65), kCentre));
}

std::vector<std::uint8_t> covered(std::size_t faces, std::initializer_list<std::size_t> at) {
  std::vector<std::uint8_t> flags(faces);
  for (const std::size_t f : at) flags[f] = 1;
  return flags;
}

// The longest run, and how many runs of each length there are.
std::vector<std::size_t> runs(const RefinableMesh& mesh, const std::vector<std::uint8_t>& flags) {
  VertexRing ring;
  EXPECT_TRUE(ring.gather(mesh, kCentre));
  std::vector<std::size_t> counts = {ring.find_runs(flags)};
  for (std::uint32_t length = 1; length <= counts[0]; ++length) {
    counts.push_back(ring.rank(mesh, length, initial_parameters().fan).size());
  }
  return counts;
}

TEST(VertexRing, FindsRunsOverTheStartOfAClosedRing) {
  EXPECT_EQ(runs(disc(6), covered(6, {2})), (std::vector<std::size_t>{5, 5, 4, 3, 2, 1}));
  EXPECT_EQ(runs(disc(6), covered(6, {1, 3})), (std::vector<std::size_t>{3, 4, 2, 1}));
  EXPECT_EQ(runs(disc(3), covered(3, {0, 1, 2})), (std::vector<std::size_t>{0}));
}

TEST(VertexRing, ASplitLeavesAnInteriorVertexAFace) {
  EXPECT_EQ(runs(disc(4), covered(4, {})), (std::vector<std::size_t>{3, 4, 4, 4}));
}

TEST(VertexRing, ASplitMayTakeAllFacesOfABorderVertexButNotAcrossTheBorder) {
  EXPECT_EQ(runs(half_disc(4), covered(4, {})), (std::vector<std::size_t>{4, 4, 3, 2, 1}));
  EXPECT_EQ(runs(half_disc(4), covered(4, {1})), (std::vector<std::size_t>{2, 3, 1}));
}

TEST(VertexRing, EveryCandidateIsARunOfFreeFaces) {
  const RefinableMesh mesh = disc(20);
  const auto flags = covered(20, {0, 3, 4, 11, 17});
  VertexRing ring;
  ASSERT_TRUE(ring.gather(mesh, kCentre));
  ring.find_runs(flags);
  for (const auto& candidate : ring.rank(mesh, 3, initial_parameters().fan)) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      EXPECT_EQ(flags[ring.face((candidate.first + i) % 20).value], 0);
    }
  }
}

TEST(VertexRing, RanksByScoreAndTiesByPlace) {
  RefinableMesh even = disc(8);
  VertexRing ring;
  ASSERT_TRUE(ring.gather(even, kCentre));
  ring.find_runs(covered(8, {}));
  const auto ties = ring.rank(even, 2, {{0, 0, 0}});
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(ties[i].first, i);
  const auto ranked = ring.rank(even, 2, initial_parameters().fan);
  EXPECT_TRUE(std::is_sorted(ranked.begin(), ranked.end(),
                             [](const auto& a, const auto& b) { return a.score > b.score; }));
}

TEST(VertexRing, LikesLongSpokesInsideWhenItsWeightsSaySo) {
  LatticeMesh star{{{500, 500, 0}}, {}};  // one spoke, to vertex 4, is three times as long
  for (const Vec3i p : {Vec3i{600, 500, 0},
                        {550, 590, 0},
                        {450, 590, 0},
                        {200, 500, 0},
                        {450, 410, 0},
                        {550, 410, 0}}) {
    star.positions.push_back(p);
  }
  for (std::uint32_t k = 0; k < 6; ++k) star.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
  const RefinableMesh mesh = *RefinableMesh::from_base(star);
  VertexRing ring;
  ASSERT_TRUE(ring.gather(mesh, kCentre));
  ring.find_runs(covered(6, {}));
  EXPECT_EQ(ring.rank(mesh, 2, {{127, 0, 0}})[0].first, 2u);  // faces 2 and 3, the spoke between
}

}  // namespace
}  // namespace pmesh
