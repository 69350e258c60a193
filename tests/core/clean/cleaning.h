// What the tests of clean() share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/io/clean.h"
#include "core/mesh/half_edge_mesh.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {

inline CleanedMesh cleaned(IndexedMesh mesh, bool is_soup = false) {
  return clean(ImportedMesh{std::move(mesh), is_soup, 0});
}

inline Result<HalfEdgeMesh> build(const IndexedMesh& mesh) {
  return HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
}

inline std::size_t border_edges(const IndexedMesh& mesh) {
  const Result<HalfEdgeMesh> built = build(mesh);
  if (!built) return SIZE_MAX;
  std::size_t count = 0;
  for (std::uint32_t h = 0; h < 3 * built->face_slots(); ++h) {
    count += built->is_border(HalfEdgeId(h)) ? 1 : 0;
  }
  return count;
}

inline std::size_t components(const IndexedMesh& mesh) {
  std::vector<std::uint32_t> parents(mesh.positions.size());
  std::iota(parents.begin(), parents.end(), 0);
  const auto root = [&](std::uint32_t v) {
    while (parents[v] != v) v = parents[v] = parents[parents[v]];
    return v;
  };
  for (const auto [a, b, c] : mesh.triangles) {
    parents[root(b)] = root(a);
    parents[root(c)] = root(a);
  }
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < parents.size(); ++v) count += root(v) == v ? 1 : 0;
  return count;
}

/// A face by its corners' positions, rotated so that the lowest comes first.
using PlacedFace = std::array<std::tuple<double, double, double>, 3>;

inline PlacedFace placed(const IndexedMesh& mesh, const Triangle& t) {
  PlacedFace face;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& p = mesh.positions[t[k]];
    face[k] = {p.x, p.y, p.z};
  }
  std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  return face;
}

inline std::vector<PlacedFace> placed_faces(const IndexedMesh& mesh) {
  std::vector<PlacedFace> faces;
  for (const Triangle& t : mesh.triangles) faces.push_back(placed(mesh, t));
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// The result builds, its counts add up, and exactly the faces that the report names are missing.
inline void expect_sound(const IndexedMesh& input, const CleanedMesh& output) {
  const Result<HalfEdgeMesh> built = build(output.mesh);
  ASSERT_TRUE(built) << built.error().message;
  EXPECT_TRUE(built->validate());

  const CleanReport& report = output.report;
  EXPECT_EQ(input.triangles.size() - output.mesh.triangles.size(),
            report.degenerate + report.duplicate);
  EXPECT_EQ(input.positions.size() + report.vertices_added,
            output.mesh.positions.size() + report.welded + report.unreferenced);

  const std::vector<PlacedFace> before = placed_faces(input), after = placed_faces(output.mesh);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), after.begin(), after.end()));
  std::vector<PlacedFace> missing;
  std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                      std::back_inserter(missing));
  std::uint64_t degenerate = 0;
  for (const PlacedFace& face : missing) {
    const bool is_degenerate = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
    const bool is_duplicate = std::binary_search(after.begin(), after.end(), face);
    EXPECT_TRUE(is_degenerate || is_duplicate);
    degenerate += is_degenerate ? 1 : 0;
  }
  EXPECT_LE(report.degenerate, degenerate);
}

}  // namespace pmesh
