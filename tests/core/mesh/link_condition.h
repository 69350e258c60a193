// The link condition, written for clarity: an edge collapse keeps the surface's topology if and
// only if link(a) and link(b) meet in link(ab) alone (Dey, Edelsbrunner, Guha, Nekhayev 1999). A
// border is closed by a cone to one more vertex, kNoIndex.
#pragma once

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

struct Link {
  std::set<std::uint32_t> vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;  // (lower, higher)

  void add_edge(std::uint32_t a, std::uint32_t b) {
    vertices.insert({a, b});
    edges.insert(std::minmax(a, b));
  }
};

inline Link link_of(const HalfEdgeMesh& mesh, VertexId v) {
  Link link;
  const HalfEdgeId first = mesh.outgoing(v);
  if (mesh.is_border(first)) link.add_edge(mesh.target(first).value, kNoIndex);
  HalfEdgeId h = first;
  do {
    link.add_edge(mesh.target(h).value, mesh.apex(h).value);
    if (mesh.is_border(mesh.prev(h))) link.add_edge(mesh.apex(h).value, kNoIndex);
    h = mesh.rotate_ccw(h);
  } while (h.valid() && h != first);
  return link;
}

/// Whether HalfEdgeMesh::collapse(removed, edge) is allowed and find_site() can undo it.
inline bool may_collapse(const HalfEdgeMesh& mesh, VertexId removed, HalfEdgeId edge) {
  const VertexId kept = mesh.origin(edge) == removed ? mesh.target(edge) : mesh.origin(edge);
  if (mesh.is_border(removed) && !mesh.is_border(edge)) return false;
  const Link a = link_of(mesh, removed), b = link_of(mesh, kept);
  if (a.edges.size() > kMaxMovedFaces) return false;
  std::set<std::uint32_t> common, of_edge{mesh.apex(edge).value};
  std::set_intersection(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                        std::inserter(common, common.end()));
  of_edge.insert(mesh.is_border(edge) ? kNoIndex : mesh.apex(mesh.twin(edge)).value);
  const bool shares_edges = std::any_of(a.edges.begin(), a.edges.end(),
                                        [&](const auto& e) { return b.edges.contains(e); });
  return common == of_edge && !shares_edges;
}

}  // namespace pmesh
