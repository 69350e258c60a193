#include "core/measure/collapse_gap.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "core/measure/patch_distance.h"
#include "core/measure/sampled_distance.h"
#include "tests/core/measure/unit_surface.h"

namespace pmesh {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

std::vector<Vec3d> regular_link(int corners, double z = 0) {
  std::vector<Vec3d> link;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners;
    link.push_back({std::cos(angle), std::sin(angle), z});
  }
  return link;
}

IndexedMesh mesh_of(const std::vector<Corners>& faces) {
  IndexedMesh mesh;
  for (const Corners& t : faces) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {t.a, t.b, t.c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// Two-sided, at points spread over the faces.
double sampled(const std::vector<Corners>& a, const std::vector<Corners>& b) {
  const IndexedMesh mesh_a = mesh_of(a), mesh_b = mesh_of(b);
  const Surface from = unit_surface(mesh_a), to = unit_surface(mesh_b);
  const SurfaceSampler of_from(from, SurfaceSampler::Over::faces, 2000, 1);
  const SurfaceSampler of_to(to, SurfaceSampler::Over::faces, 2000, 1);
  return std::max({sampled_distance(from, of_from, to, 1).max,
                   sampled_distance(to, of_to, from, 1).max, vertex_distance(from, to, 1).max,
                   vertex_distance(to, from, 1).max});
}

std::vector<Corners> fan(Vec3d center, const std::vector<Vec3d>& link, std::size_t begin,
                         std::size_t end) {
  std::vector<Corners> faces;
  for (std::size_t i = begin; i < end; ++i) {
    faces.push_back({center, link[i], link[(i + 1) % link.size()]});
  }
  return faces;
}

std::vector<Corners> joined(std::vector<Corners> a, const std::vector<Corners>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(CollapseGap, IsNothingInAPlane) {
  CollapseGap gap;
  const std::vector<Vec3d> link = regular_link(7);
  EXPECT_NEAR(gap.of_half_edge({0.2, 0.3, 0}, link, false).value(), 0, 1e-15);
  EXPECT_NEAR(gap.of_edge({0.2, 0.1, 0}, {-0.1, -0.3, 0}, {0, 0.1, 0}, link, 3).value(), 0, 1e-15);
}

TEST(CollapseGap, IsTheHeightOfAPeak) {
  CollapseGap gap;
  EXPECT_NEAR(gap.of_half_edge({0, 0, 0.5}, regular_link(6), false).value(), 0.5, 1e-12);
  EXPECT_NEAR(gap.of_edge({0, 0.3, 0}, {0, -0.3, 0}, {0, 0, 0.7}, regular_link(6), 3).value(), 0.7,
              1e-12);
}

TEST(CollapseGap, BoundsTheDistanceOfRandomFans) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  CollapseGap gap;
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec3d> link = regular_link(3 + i % 7);
    for (Vec3d& p : link) p += 0.3 * Vec3d{unit(random), unit(random), unit(random)};
    const Vec3d removed{0.4 * unit(random), 0.4 * unit(random), unit(random)};
    const std::optional<double> found = gap.of_half_edge(removed, link, false);
    if (!found) continue;
    const double distance =
        sampled(fan(removed, link, 0, link.size()), fan(link[0], link, 1, link.size() - 1));
    EXPECT_GE(*found, distance - 1e-12);
    EXPECT_LE(*found, 12 * distance + 1e-12);
  }
}

TEST(CollapseGap, BoundsTheDistanceOfRandomEdgeCollapses) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  CollapseGap gap;
  int bounded = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec3d> link = regular_link(4 + i % 6);
    for (Vec3d& p : link) p += 0.2 * Vec3d{unit(random), unit(random), unit(random)};
    const auto inner = [&] {
      return Vec3d{0.3 * unit(random), 0.3 * unit(random), 0.5 * unit(random)};
    };
    const std::size_t right = 1 + static_cast<std::size_t>(i) % (link.size() - 2);
    const Vec3d first = inner(), second = inner(), merged = inner();
    const std::optional<double> found = gap.of_edge(first, second, merged, link, right);
    if (!found) continue;
    ++bounded;
    std::vector<Corners> before =
        joined(fan(first, link, 0, right), fan(second, link, right, link.size()));
    before.push_back({first, link[right], second});
    before.push_back({first, second, link[0]});
    EXPECT_GE(*found, sampled(before, fan(merged, link, 0, link.size())) - 1e-12);
  }
  EXPECT_GT(bounded, 20);
}

TEST(CollapseGap, OfABorderIsHowFarTheBorderMoves) {
  CollapseGap gap;
  const std::vector<Vec3d> path = {{1, 0, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, 0, 0}};
  EXPECT_NEAR(gap.of_half_edge({0, 0, 0}, path, true).value(), 0, 1e-15);
  EXPECT_NEAR(gap.of_half_edge({0.2, -0.1, 0}, path, true).value(), 0.1, 1e-15);
  const std::vector<Vec3d> ear = {{1, 0, 0}, {-1, 0, 0}};
  EXPECT_NEAR(gap.of_half_edge({0.2, -0.3, 0}, ear, true).value(), 0.3, 1e-15);
}

TEST(CollapseGap, KnowsNothingOfFoldedFans) {
  CollapseGap gap;
  std::vector<Vec3d> link = regular_link(6);
  EXPECT_FALSE(gap.of_half_edge({3, 0, 0}, link, false));  // beyond the link
  link[1] = {0.2, 0.1, 0};                                 // the fan after it folds
  EXPECT_FALSE(gap.of_half_edge({-0.5, 0, 0}, link, false));
  const std::vector<Vec3d> twice = {{1, 0, 0},   {-0.5, 0.8, 0}, {-0.5, -0.8, 0},
                                    {1, 0.1, 0}, {-0.4, 0.9, 0}, {-0.4, -0.9, 0}};
  EXPECT_FALSE(gap.of_half_edge({0, 0, 0}, twice, false));
}

// For a fan of many faces, heights alone are compared.
TEST(CollapseGap, BoundsALargeFan) {
  CollapseGap gap;
  const std::vector<Vec3d> link = regular_link(200);
  EXPECT_NEAR(gap.of_half_edge({0.1, 0, 0}, link, false).value(), 0, 1e-15);
  EXPECT_NEAR(gap.of_half_edge({0.1, 0, 0.25}, link, false).value(), 0.25, 1e-12);
}

TEST(PatchDistance, BoundsTheDistanceOfAnyFans) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 300; ++i) {
    std::vector<Vec3d> link;
    for (int k = 0; k < 4 + i % 6; ++k)
      link.push_back({unit(random), unit(random), 0.2 * unit(random)});
    const auto before = fan({unit(random), unit(random), 0}, link, 0, link.size());
    const auto after = fan(link[0], link, 1, link.size() - 1);
    const double bound = std::max(patch_distance(before, after, {}, kNoLimit),
                                  patch_distance(after, before, {}, kNoLimit));
    EXPECT_GE(bound, sampled(before, after) - 1e-12);
  }
}

TEST(PatchDistance, IsSharpOverFlatTiles) {
  const std::vector<Vec3d> link = regular_link(6);
  const auto after = fan(link[0], link, 1, link.size() - 1);
  EXPECT_NEAR(patch_distance(fan({0, 0, 0}, link, 0, 6), after, {}, kNoLimit), 0, 1e-15);
  const double peak = patch_distance(fan({0, 0, 0.5}, link, 0, 6), after, {}, kNoLimit);
  EXPECT_GE(peak, 0.5);
  EXPECT_LE(peak, 0.75);
}

// A sliver that folds over the link is above a face beyond it.
TEST(PatchDistance, CountsTheFacesAround) {
  const std::vector<Corners> sliver = {{{0, 0, 0}, {2, 0, 0}, {1, -0.01, 0}}};
  const std::vector<Corners> inside = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                       {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}}};
  const std::vector<Corners> around = {{{0, 0, 0}, {1, -1, 0}, {2, 0, 0}}};
  EXPECT_NEAR(patch_distance(sliver, inside, around, kNoLimit), 0, 1e-15);
  EXPECT_LE(patch_distance(sliver, inside, {}, kNoLimit), 0.25);
  EXPECT_EQ(patch_distance(sliver, {}, {}, 7), 7);
}

}  // namespace
}  // namespace pmesh
