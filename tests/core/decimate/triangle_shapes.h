// What the tests of triangle collapses share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/decimate/triangle_star.h"
#include "tests/core/decimate/rings.h"
#include "tests/core/mesh/link_condition.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {

/// `mesh` with a vertex in the middle of every `stride`-th face, from face 0 on.
inline IndexedMesh spiked(IndexedMesh mesh, std::size_t stride) {
  const std::size_t faces = mesh.triangles.size();
  for (std::size_t f = 0; f < faces; f += stride) {
    const auto [a, b, c] = mesh.triangles[f];
    const auto spike = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(0.4 * (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]));
    mesh.triangles[f] = {a, b, spike};
    mesh.triangles.push_back({b, c, spike});
    mesh.triangles.push_back({c, a, spike});
  }
  return mesh;
}

/// Small meshes with flat, bumpy and folded parts, vertices of low valence, borders and handles.
inline std::vector<shapes::Shape> triangle_shapes() {
  return {{"Tetrahedron", shapes::tetrahedron()},
          {"Octahedron", shapes::octahedron()},
          {"Bipyramid", spiked(shapes::tetrahedron(), 4)},
          {"SpikedSphere", spiked(shapes::icosphere(2), 3)},
          {"SpikesAllOver", spiked(shapes::icosphere(1), 1)},
          {"Sphere", shapes::bumped(shapes::icosphere(2), 0.05)},
          {"CrumpledSphere", shapes::bumped(shapes::icosphere(2), 0.6)},
          {"Torus", shapes::bumped(shapes::torus(7, 3), 0.1)},
          {"Grid", shapes::grid(7, 6)},
          {"CrumpledGrid", shapes::bumped(shapes::grid(9, 9), 0.4)},
          {"Degenerate", shapes::lattice_degenerate(10)},
          {"Genus", shapes::genus(3)}};
}

/// The star of `face`, if it has one.
inline std::optional<TriangleStar> star_of(const WorkingMesh& work, FaceId face) {
  TriangleStar star;
  if (!gather_triangle(work, face, star) || !gather_star(work, star)) return std::nullopt;
  return star;
}

/// Calls `visit(work, face, star)` for every face of `mesh` that has a star.
template <class Visit>
void for_each_star(const IndexedMesh& mesh, const Visit& visit) {
  const WorkingMesh work(half_edges(mesh), mesh.positions);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const std::optional<TriangleStar> star = star_of(work, FaceId(f));
    if (star) visit(work, FaceId(f), *star);
  }
}

/// `mesh` after both collapses in that order of corners, if both keep the link condition.
inline std::optional<HalfEdgeMesh> merged(HalfEdgeMesh mesh, const TriangleStar& star,
                                          const std::array<std::uint32_t, 3>& order) {
  const VertexId kept = star.corners[order[2]];
  for (const std::uint32_t corner : {order[0], order[1]}) {
    const VertexId removed = star.corners[corner];
    const HalfEdgeId edge = mesh.find_edge(removed, kept);
    if (!may_collapse(mesh, removed, edge)) return std::nullopt;
    mesh.collapse(removed, edge);
  }
  return mesh;
}

inline std::uint32_t valence(const HalfEdgeMesh& mesh, VertexId v) {
  std::uint32_t faces = 0;
  for (std::uint32_t h = 0; h < mesh.corners().size(); ++h) faces += mesh.corners()[h] == v;
  return faces;
}

}  // namespace pmesh
