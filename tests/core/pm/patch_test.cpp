#include "core/pm/patch.h"

#include <array>

#include <gtest/gtest.h>

#include "core/pm/split_model.h"

namespace pmesh {
namespace {

// A hexagon of six faces around vertex 0, in the plane z = 0, and one vertex off it.
LatticeMesh hexagon(std::int32_t radius, Vec3i centre, std::int32_t bump = 0) {
  LatticeMesh mesh{{centre}, {}};
  const std::int32_t half = radius / 2;
  for (const Vec3i p : {Vec3i{radius, 0, 0},
                        {half, radius, bump},
                        {-half, radius, 0},
                        {-radius, 0, 0},
                        {-half, -radius, 0},
                        {half, -radius, 0}}) {
    mesh.positions.push_back(centre + p);
  }
  for (std::uint32_t k = 0; k < 6; ++k) mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
  return mesh;
}

Patch gather(const LatticeMesh& base, const SplitSite& site) {
  const RefinableMesh mesh = *RefinableMesh::from_base(base);
  EXPECT_TRUE(mesh.connectivity().check(site).ok());
  Fan fan;
  fan.walk(mesh.connectivity(), site);
  Patch patch;
  patch.gather(mesh, fan);
  return patch;
}

constexpr SplitSite kTwoFaces = {HalfEdgeId(0), 2, SplitKind::interior};

std::vector<Vec3i> polygon(const Patch& patch) {
  std::vector<Vec3i> points;
  for (const Int4& point : patch.polygon()) points.push_back({point[0], point[1], point[2]});
  return points;
}

TEST(Patch, HoldsTheFansOutlineAroundItsKeptVertexInEighths) {
  const Patch patch = gather(hexagon(100, {500, 500, 300}), kTwoFaces);
  EXPECT_EQ(patch.kept, (Vec3i{500, 500, 300}));
  EXPECT_EQ(patch.faces, 2u);
  EXPECT_EQ(patch.shift, 0);
  EXPECT_EQ(polygon(patch), (std::vector<Vec3i>{{800, 0, 0}, {400, 800, 0}, {-400, 800, 0}}));
  EXPECT_EQ(patch.centroid, (Vec3l{200, 400, 0}));
  EXPECT_EQ(patch.local({501, 500, 298}), (Vec3l{8, 0, -16}));
}

TEST(Patch, LooksAcrossTheFansEdges) {
  const Patch patch = gather(hexagon(100, {500, 500, 300}), kTwoFaces);
  // Parallelograms over the faces before and after the fan, and none across the border: the means
  // of (100,0) - (50,-100) and (-50,100) - (-100,0), in eighths.
  EXPECT_EQ(patch.centroid + patch.features[2], (Vec3l{400, 800, 0}));
}

TEST(Patch, ItsNormalStandsOnAFlatFan) {
  const Patch patch = gather(hexagon(100, {500, 500, 300}), kTwoFaces);
  EXPECT_EQ(patch.normal.x, 0);
  EXPECT_EQ(patch.normal.y, 0);
  EXPECT_GT(patch.normal.z, 0);
  EXPECT_EQ(patch.flatness, 0);
  EXPECT_GT(gather(hexagon(100, {500, 500, 300}, 60), kTwoFaces).flatness, 0);
}

TEST(Patch, FansArePredictedByTheirSizeAndThoseOnBordersAlike) {
  const auto fan_class = [](std::uint32_t half_edge, std::uint16_t moved, SplitKind kind) {
    return gather(hexagon(100, {500, 500, 300}), {HalfEdgeId(half_edge), moved, kind}).fan_class();
  };
  constexpr std::array<std::size_t, 5> kInterior = {0, 0, 1, 2, 3};  // of one to five faces
  for (std::uint16_t moved = 1; moved <= 5; ++moved) {
    EXPECT_EQ(fan_class(0, moved, SplitKind::interior), kInterior[moved - 1u]);
  }
  for (std::uint16_t moved = 0; moved <= 2; ++moved) {
    EXPECT_EQ(fan_class(1, moved, SplitKind::border_first), kBorderFans);
    EXPECT_EQ(fan_class(1, moved, SplitKind::border_last), kBorderFans);
  }
}

TEST(Patch, EachClassOfFansHasWeightsOfItsOwn) {
  const Patch patch = gather(hexagon(100, {500, 500, 300}), kTwoFaces);
  const Predictor before = initial_parameters().predictor;
  for (std::size_t changed = 0; changed < kFanClasses; ++changed) {
    Predictor predictor = before;
    predictor.fans[changed] = {{32, 0, 0, 0}, {0, 32}};
    EXPECT_EQ(predict(patch, predictor).at != predict(patch, before).at,
              changed == patch.fan_class());
  }
}

// Every kind of split of every vertex.
std::vector<SplitSite> sites(const LatticeMesh& base) {
  const RefinableMesh mesh = *RefinableMesh::from_base(base);
  std::vector<SplitSite> found;
  for (HalfEdgeId h(0); h.value < 3 * mesh.face_count(); ++h.value) {
    for (const auto kind : {SplitKind::interior, SplitKind::border_first, SplitKind::border_last}) {
      for (std::uint16_t moved = 0; moved < 6; ++moved) {
        const SplitSite site{h, moved, kind};
        if (mesh.connectivity().check(site).ok()) found.push_back(site);
      }
    }
  }
  return found;
}

TEST(Patch, TheSameAnywhereInSpace) {
  const LatticeMesh here = hexagon(300, {500, 600, 100}, 77);
  const Vec3i by{(1 << 29) + 3, 12345, 1 << 28};
  const LatticeMesh there = hexagon(300, Vec3i{500, 600, 100} + by, 77);
  const Predictor predictor = initial_parameters().predictor;
  const Vec3i added{543, 610, 90};
  for (const SplitSite& site : sites(here)) {
    const Patch a = gather(here, site), b = gather(there, site);
    EXPECT_EQ(polygon(a), polygon(b));
    EXPECT_EQ(a.features, b.features);
    EXPECT_EQ(predict(a, predictor).at, predict(b, predictor).at);
    EXPECT_EQ(predict(a, predictor).normal_class, predict(b, predictor).normal_class);
    EXPECT_EQ(predict_kept(a, predictor, added).at, predict_kept(b, predictor, added + by).at);
    EXPECT_EQ(split_cost(a, added), split_cost(b, added + by));
  }
}

TEST(Patch, ABorderFanReadsTheSameFromBothEnds) {
  const LatticeMesh two{{{0, 0, 0}, {100, 0, 0}, {100, 90, 0}, {0, 80, 5}}, {{0, 1, 2}, {0, 2, 3}}};
  const Patch first = gather(two, {HalfEdgeId(0), 2, SplitKind::border_first});
  const Patch last = gather(two, {HalfEdgeId(5), 2, SplitKind::border_last});
  const auto ends = polygon(last);
  EXPECT_EQ(polygon(first), (std::vector<Vec3i>{ends.rbegin(), ends.rend()}));
  EXPECT_EQ(first.centroid, last.centroid);
}

TEST(Patch, AnEarMirrorsTheFaceThatItIsGluedTo) {
  const LatticeMesh one{{{0, 0, 0}, {100, 0, 0}, {50, 80, 0}}, {{0, 1, 2}}};
  const Patch ear = gather(one, {HalfEdgeId(0), 0, SplitKind::border_first});
  EXPECT_EQ(polygon(ear), (std::vector<Vec3i>{{800, 0, 0}}));
  EXPECT_EQ(ear.centroid + ear.features[2], (Vec3l{400, -640, 0}));
}

// Whatever is measured must lie in the ranges that the header gives, for any new vertex.
void expect_in_range(const Patch& patch, const Predictor& predictor, Vec3i added) {
  EXPECT_NE(patch.normal, Vec3l{});
  EXPECT_LE(largest(patch.normal), std::int64_t{1} << kLocalBits);
  for (const Vec3i p : polygon(patch)) {
    EXPECT_LE(largest({p.x, p.y, p.z}), std::int64_t{1} << kLocalBits);
  }
  for (const Prediction& at : {predict(patch, predictor), predict_kept(patch, predictor, added)}) {
    EXPECT_LT(largest(at.at), std::int64_t{1} << 32);
    for (const int index : {at.tangential_class, at.normal_class}) {
      EXPECT_TRUE(0 <= index && index < 64);
    }
  }
  EXPECT_LE(largest(patch.local(added)), kLocalReach);
  split_cost(patch, added);
}

std::vector<Predictor> extreme_predictors() {
  std::vector<Predictor> predictors = {initial_parameters().predictor};
  for (const std::int64_t most : {kMostWeight, -kMostWeight}) {
    const Predictor::Weights same{{most, most, most, most}, {most, most}};
    const Predictor::Weights against{{most, -most, most, -most}, {-most, most}};
    predictors.push_back({{}, {most, most}});
    predictors.back().fans.fill(same);
    predictors.push_back({{}, {-most, most}});
    predictors.back().fans.fill(against);
  }
  return predictors;
}

void expect_all_in_range(const LatticeMesh& mesh) {
  constexpr std::int32_t kLast = (1 << 30) - 1;
  for (const SplitSite& site : sites(mesh)) {
    const Patch patch = gather(mesh, site);
    for (const Predictor& predictor : extreme_predictors()) {
      for (const Vec3i added : {Vec3i{}, Vec3i{kLast, kLast, kLast}, patch.kept, {0, kLast, 7}}) {
        expect_in_range(patch, predictor, added);
      }
    }
  }
}

TEST(Patch, StaysInRangeFromCornerToCornerOfTheFinestLattice) {
  constexpr std::int32_t kLast = (1 << 30) - 1;
  LatticeMesh mesh = hexagon(0, {});
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    for (std::size_t turn = 0; turn < 7; ++turn) {
      const std::size_t corner = v * (turn + 1) + turn;
      mesh.positions[v] = {corner % 2 != 0 ? kLast : 0, corner / 2 % 2 != 0 ? kLast : 0,
                           corner / 4 % 2 != 0 ? kLast : 0};
      expect_all_in_range(mesh);
    }
  }
}

TEST(Patch, StaysInRangeForFansWithoutArea) {
  expect_all_in_range(hexagon(0, {5, 5, 5}));  // all in one point
  LatticeMesh line = hexagon(0, {});
  for (std::int32_t v = 0; v < 7; ++v) {
    line.positions[static_cast<std::size_t>(v)] = {3 * v * v, 0, 0};
  }
  expect_all_in_range(line);
  LatticeMesh folded = hexagon(40, {100, 100, 100});
  folded.positions[3] = folded.positions[1];  // the two faces cancel out
  expect_all_in_range(folded);
}

}  // namespace
}  // namespace pmesh
