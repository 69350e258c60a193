#include "core/pm/fan_choice.h"

#include <array>

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

std::vector<std::uint8_t> covered(std::size_t faces, std::initializer_list<std::size_t> at) {
  std::vector<std::uint8_t> flags(faces);
  for (const std::size_t f : at) flags[f] = 1;
  return flags;
}

TEST(VertexRing, StartsAtTheSmallestFaceOfAnInteriorVertex) {
  const RefinableMesh mesh = make_split_base("ball", shapes::icosphere(2), 10, false).refinable();
  for (VertexId v(0); v.value < mesh.vertex_count(); ++v.value) {
    VertexRing ring;
    ASSERT_TRUE(ring.gather(mesh, v, covered(mesh.face_count(), {})));
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
  ASSERT_TRUE(ring.gather(mesh, kCentre, covered(5, {1})));
  EXPECT_TRUE(ring.border());
  EXPECT_EQ(ring.faces(), 5u);
  EXPECT_EQ(ring.half_edge(0), mesh.connectivity().outgoing(kCentre));
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(ring.is_free(i), ring.face(i) != FaceId(1));
}

TEST(VertexRing, HoldsSixtyFourFacesAndNoMore) {
  VertexRing ring;
  EXPECT_TRUE(ring.gather(disc(64), kCentre, covered(64, {})));
  EXPECT_EQ(ring.faces(), 64u);
  EXPECT_FALSE(ring.gather(disc(65), kCentre, covered(65, {})));
  EXPECT_TRUE(ring.gather(half_disc(64), kCentre, covered(64, {})));
  EXPECT_FALSE(ring.gather(half_disc(65), kCentre, covered(65, {})));
}

// The longest run, and how many runs of each length there are.
std::vector<std::size_t> runs(const RefinableMesh& mesh, const std::vector<std::uint8_t>& flags) {
  VertexRing ring;
  EXPECT_TRUE(ring.gather(mesh, kCentre, flags));
  std::vector<std::size_t> counts = {ring.find_runs()};
  for (std::uint32_t length = 1; length <= counts[0]; ++length) {
    ring.score(length, initial_parameters().fan);
    counts.push_back(ring.candidates().size());
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
  ASSERT_TRUE(ring.gather(mesh, kCentre, flags));
  ring.find_runs();
  ring.score(3, initial_parameters().fan);
  for (const VertexRing::Candidate candidate : ring.candidates()) {
    const auto half_edges = ring.run(VertexRing::first_face(candidate), 3);
    EXPECT_EQ(half_edges[0], ring.half_edge(VertexRing::first_face(candidate)));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(flags[HalfEdgeMesh::face(half_edges[i]).value], 0);
      if (i == 0) continue;
      EXPECT_EQ(mesh.connectivity().rotate_ccw(half_edges[i - 1]), half_edges[i]);
    }
  }
}

// All candidates, likeliest first.
std::vector<VertexRing::Candidate> ranked(const VertexRing& ring) {
  std::vector<VertexRing::Candidate> all;
  for (auto next = ring.likeliest(); next[0] != VertexRing::kNone; next = ring.likeliest(next[0])) {
    all.push_back(next[0]);
  }
  return all;
}

TEST(VertexRing, RanksByScoreAndTiesByPlace) {
  const RefinableMesh even = disc(8);
  VertexRing ring;
  ASSERT_TRUE(ring.gather(even, kCentre, covered(8, {})));
  ring.find_runs();
  ring.score(2, {{0, 0, 0}});
  const auto ties = ranked(ring);
  ASSERT_EQ(ties.size(), 8u);
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(VertexRing::first_face(ties[i]), i);
}

TEST(VertexRing, ScoresTheSameAgain) {
  const RefinableMesh mesh = disc(7);
  VertexRing ring;
  ASSERT_TRUE(ring.gather(mesh, kCentre, covered(7, {2})));
  ring.find_runs();
  ring.score(2, initial_parameters().fan);
  const auto first = ranked(ring);
  const auto unit = ring.score_unit();
  for (const std::uint32_t length : {1u, 3u, 2u}) ring.score(length, initial_parameters().fan);
  EXPECT_EQ(ranked(ring), first);
  EXPECT_EQ(ring.score_unit(), unit);
}

// Spokes of 800, 1600, 800 and 2400 along the axes, in eighths: M = 1400. The run of the faces 0
// and 1 has I = 1600, C = 1600 and E = (0, 1600); that of the faces 1 and 2 I = 800, C = 4000 and
// E = (-800, -800).
TEST(VertexRing, ScoresByTheThreeLengths) {
  LatticeMesh cross{{{500, 500, 0}, {600, 500, 0}, {500, 700, 0}, {400, 500, 0}, {500, 200, 0}},
                    {}};
  for (std::uint32_t k = 0; k < 4; ++k) cross.triangles.push_back({0, 1 + k, 1 + (k + 1) % 4});
  const RefinableMesh mesh = *RefinableMesh::from_base(cross);
  VertexRing ring;
  ASSERT_TRUE(ring.gather(mesh, kCentre, covered(4, {})));
  ring.find_runs();
  ring.score(2, {{1, 1, 1}});
  EXPECT_EQ(ring.score_unit(), 2 * 1 * 4 * 1400);
  EXPECT_EQ(ring.terms(0), (std::array<std::int64_t, 3>{8 * 1600, 4 * 1600, 2 * 1600}));
  EXPECT_EQ(ring.terms(1), (std::array<std::int64_t, 3>{8 * 800, 4 * 4000, 2 * 1131}));
  const auto score = [&](std::uint32_t first) {
    const auto of = ring.terms(first);
    return of[0] + of[1] + of[2];
  };
  for (const auto candidate : ring.candidates()) {
    EXPECT_EQ(candidate >> 6, score(VertexRing::first_face(candidate)));
  }
}

TEST(VertexRing, TheLikeliestThreeAreTheNextInRank) {
  VertexRing ring;
  ASSERT_TRUE(ring.gather(disc(5), kCentre, covered(5, {})));
  ring.find_runs();
  ring.score(2, initial_parameters().fan);
  auto all = ranked(ring);
  ASSERT_EQ(all.size(), 5u);
  all.resize(8, VertexRing::kNone);
  for (std::size_t rank = 0; rank < 5; ++rank) {
    const auto next = ring.likeliest(rank == 0 ? VertexRing::kAll : all[rank - 1]);
    EXPECT_EQ(next, (std::array{all[rank], all[rank + 1], all[rank + 2]}));
  }
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
  ASSERT_TRUE(ring.gather(mesh, kCentre, covered(6, {})));
  ring.find_runs();
  ring.score(2, {{127, 0, 0}});
  EXPECT_EQ(VertexRing::first_face(ring.likeliest()[0]), 2u);  // faces 2 and 3, the spoke between
}

}  // namespace
}  // namespace pmesh
