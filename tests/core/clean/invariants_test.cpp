// What clean() promises of any mesh, on every generated shape and on random ones.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "tests/core/clean/cleaning.h"

namespace pmesh {
namespace {

std::vector<shapes::Shape> all_shapes() {
  std::vector<shapes::Shape> all = shapes::manifolds();
  for (shapes::Shape& shape : shapes::non_manifolds()) all.push_back(std::move(shape));
  return all;
}

class CleanOnEveryShape : public testing::TestWithParam<shapes::Shape> {};

TEST_P(CleanOnEveryShape, GivesAManifoldOfTheSameFaces) {
  const IndexedMesh& mesh = GetParam().mesh;
  expect_sound(mesh, cleaned(mesh));
}

TEST_P(CleanOnEveryShape, GivesAManifoldOfTheSameFacesFromASoup) {
  const IndexedMesh soup = shapes::soup(GetParam().mesh);
  expect_sound(soup, cleaned(soup, true));
}

TEST_P(CleanOnEveryShape, CleansTwoSidedSurfaces) {
  IndexedMesh mesh = GetParam().mesh;
  const std::vector<Triangle> front = mesh.triangles;
  for (const auto [a, b, c] : front) mesh.triangles.push_back({a, c, b});
  expect_sound(mesh, cleaned(mesh));
}

TEST_P(CleanOnEveryShape, FindsNothingMoreTheSecondTime) {
  // A second weld would join the cuts' copies again, so only the topology is asked here.
  const CleanedMesh once = cleaned(GetParam().mesh);
  IndexedMesh apart = once.mesh;
  for (std::size_t v = 0; v < apart.positions.size(); ++v) apart.positions[v].x = double(v);
  const CleanedMesh twice = cleaned(apart);
  EXPECT_EQ(twice.mesh.triangles, once.mesh.triangles);
  EXPECT_EQ(twice.report.vertices_added, 0u);
}

INSTANTIATE_TEST_SUITE_P(Clean, CleanOnEveryShape, testing::ValuesIn(all_shapes()),
                         [](const auto& shape) { return shape.param.name; });

// Any faces over a few vertices: dense enough that everything that can go wrong does.
IndexedMesh random_mesh(std::mt19937& random) {
  const auto vertex_count = static_cast<std::uint32_t>(3 + random() % 7);
  const auto face_count = static_cast<std::uint32_t>(1 + random() % 24);
  IndexedMesh mesh;
  for (std::uint32_t v = 0; v < vertex_count; ++v) mesh.positions.push_back({double(v), 0, 1});
  for (std::uint32_t f = 0; f < face_count; ++f) {
    Triangle t;
    for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random() % vertex_count);
    mesh.triangles.push_back(t);
    if (random() % 3 == 0) mesh.triangles.push_back({t[0], t[2], t[1]});
  }
  return mesh;
}

std::set<Triangle> proper_faces(const std::vector<Triangle>& triangles) {
  std::set<Triangle> faces;
  for (Triangle t : triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    faces.insert(t);
  }
  return faces;
}

TEST(CleanRandom, GivesAManifoldOfTheSameFaces) {
  std::mt19937 random(2024);
  for (int round = 0; round < 20000; ++round) {
    const IndexedMesh mesh = random_mesh(random);
    const CleanedMesh result = cleaned(mesh);
    expect_sound(mesh, result);
    ASSERT_EQ(result.mesh.triangles.size(), proper_faces(mesh.triangles).size()) << round;
    if (HasFailure()) FAIL() << "in round " << round;
  }
}

// A random mesh without degenerate and duplicate faces, so that clean() keeps each one's number.
IndexedMesh random_mesh_without_repeats(std::mt19937& random) {
  IndexedMesh mesh = random_mesh(random);
  const std::set<Triangle> faces = proper_faces(mesh.triangles);
  mesh.triangles.assign(faces.begin(), faces.end());
  return mesh;
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

TEST(CleanRandom, OppositeCopiesShareNoVertex) {
  std::mt19937 random(7);
  for (int round = 0; round < 5000; ++round) {
    const IndexedMesh mesh = random_mesh_without_repeats(random);
    const std::vector<Triangle> cut = cleaned(mesh).mesh.triangles;
    std::map<Triangle, std::size_t> first_copy;
    for (std::size_t f = 0; f < cut.size(); ++f) {
      const auto [copy, is_first] = first_copy.try_emplace(sorted(mesh.triangles[f]), f);
      if (is_first) continue;
      const Triangle& other = cut[copy->second];
      ASSERT_EQ(std::find_first_of(cut[f].begin(), cut[f].end(), other.begin(), other.end()),
                cut[f].end())
          << round;
    }
  }
}

TEST(CleanRandom, FacesThatFitStayNeighbours) {
  struct Use {
    std::size_t face, from, to;  // corners
  };
  std::mt19937 random(8);
  for (int round = 0; round < 5000; ++round) {
    const IndexedMesh mesh = random_mesh_without_repeats(random);
    const std::vector<Triangle> cut = cleaned(mesh).mesh.triangles;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Use>> edges;
    for (std::size_t f = 0; f < cut.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Use use{f, k, (k + 1) % 3};
        edges[std::minmax(mesh.triangles[f][use.from], mesh.triangles[f][use.to])].push_back(use);
      }
    }
    for (const auto& [edge, uses] : edges) {
      if (uses.size() != 2) continue;
      const Use &a = uses[0], &b = uses[1];
      const Triangle &before_a = mesh.triangles[a.face], &before_b = mesh.triangles[b.face];
      if (before_a[a.from] != before_b[b.to] || sorted(before_a) == sorted(before_b)) continue;
      ASSERT_EQ(cut[a.face][a.from], cut[b.face][b.to]) << round;
      ASSERT_EQ(cut[a.face][a.to], cut[b.face][b.from]) << round;
    }
  }
}

}  // namespace
}  // namespace pmesh
