#include "core/measure/face_neighbours.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/ids.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

std::vector<std::array<std::uint32_t, 3>> neighbours_of(const IndexedMesh& mesh) {
  return face_neighbours(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
}

bool has(const Triangle& t, std::uint32_t vertex) {
  return std::find(t.begin(), t.end(), vertex) != t.end();
}

TEST(FaceNeighbours, ShareTheEdge) {
  for (const auto& shapes : {shapes::manifolds(), shapes::non_manifolds()}) {
    for (const shapes::Shape& shape : shapes) {
      const auto neighbours = neighbours_of(shape.mesh);
      for (std::uint32_t face = 0; face < neighbours.size(); ++face) {
        const Triangle& t = shape.mesh.triangles[face];
        for (std::size_t k = 0; k < 3; ++k) {
          if (neighbours[face][k] == kNoIndex) continue;
          const Triangle& other = shape.mesh.triangles[neighbours[face][k]];
          EXPECT_TRUE(has(other, t[k]) && has(other, t[(k + 1) % 3])) << shape.name;
        }
      }
    }
  }
}

TEST(FaceNeighbours, AreMutualOnAManifold) {
  const auto neighbours = neighbours_of(shapes::torus(12, 7));
  for (std::uint32_t face = 0; face < neighbours.size(); ++face) {
    for (const std::uint32_t other : neighbours[face]) {
      ASSERT_NE(other, kNoIndex);
      EXPECT_EQ(std::count(neighbours[other].begin(), neighbours[other].end(), face), 1);
    }
  }
}

TEST(FaceNeighbours, EndAtBorders) {
  const auto neighbours = neighbours_of(shapes::grid(5, 3));
  std::ptrdiff_t borders = 0;
  for (const auto& around : neighbours)
    borders += std::count(around.begin(), around.end(), kNoIndex);
  EXPECT_EQ(borders, 2 * (5 + 3));
}

}  // namespace
}  // namespace pmesh
