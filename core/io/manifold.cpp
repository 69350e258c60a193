// Why the result is a manifold. Call a half-edge single if match_edges() left it unmatched.
//
// 1. No fan has both copies of an opposite pair. Suppose a fan around u leads, ccw, from f over
// edge
//    uw to its copy f', which it enters over uw too. f and f' do not match each other, so f leaves
//    to some g and f' is entered from some g', with opposite directions of uw: four faces, which
//    match only if g and g' are a pair as well. They are in the same fan, two steps closer
//    together; and so on, until a face would be its own copy or match it.
// 2. After split_fans() every vertex has one fan, which begins with at most one single and ends
//    with at most one. Two singles with the same ends therefore run in opposite directions: they
//    are an edge again, which closes both fans.
// 3. A matched couple has its ends for itself: other half-edges of its input edge belong to an
//    opposite pair of which the couple has the other copy, and by 1 their ends are other vertices.
#include "core/io/manifold.h"

#include <span>
#include <utility>
#include <vector>

#include "core/io/edge_matching.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {
namespace {

HalfEdgeId first_of_fan(HalfEdgeId h, std::span<const HalfEdgeId> twins) {
  const HalfEdgeId start = h;
  while (twins[h.value].valid()) {
    h = HalfEdgeMesh::next(twins[h.value]);
    if (h == start) break;
  }
  return h;
}

// The first fan of every vertex keeps it, each other one gets a copy. Returns the vertices copied,
// once for each copy.
std::vector<std::uint32_t> split_fans(IndexedMesh& mesh, std::span<const HalfEdgeId> twins) {
  std::vector<std::uint32_t> copied;
  std::vector<bool> corner_done(twins.size()), vertex_taken(mesh.positions.size());
  const auto origin = [&](HalfEdgeId h) -> std::uint32_t& {
    return mesh.triangles[h.value / 3][h.value % 3];
  };
  for (std::uint32_t corner = 0; corner < twins.size(); ++corner) {
    if (corner_done[corner]) continue;
    std::uint32_t vertex = origin(HalfEdgeId(corner));
    if (vertex_taken[vertex]) {
      copied.push_back(vertex);
      const Vec3d position = mesh.positions[vertex];
      vertex = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(position);
    } else {
      vertex_taken[vertex] = true;
    }
    for (HalfEdgeId h = first_of_fan(HalfEdgeId(corner), twins); h.valid() && !corner_done[h.value];
         h = twins[HalfEdgeMesh::prev(h).value]) {
      origin(h) = vertex;
      corner_done[h.value] = true;
    }
  }
  return copied;
}

}  // namespace

CutReport cut_to_manifold(IndexedMesh& mesh) {
  const auto vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  EdgeMatching matching = match_edges(mesh.triangles, vertex_count);
  const std::vector<std::uint32_t> copied = split_fans(mesh, matching.twins);

  CutReport report;
  report.opposite_pairs = matching.opposite_pairs;
  report.nonmanifold_edges_cut = matching.nonmanifold_edges_cut;
  report.winding_edges_cut = matching.winding_edges_cut;
  report.vertices_added = copied.size();
  std::vector<bool> counted = std::move(matching.touched);
  for (const std::uint32_t vertex : copied) {
    if (!counted[vertex]) ++report.nonmanifold_vertices_cut;
    counted[vertex] = true;
  }
  return report;
}

}  // namespace pmesh
