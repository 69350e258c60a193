// Visits the edges of any triangles, however many faces an edge may have.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// One face's side of an edge. Half-edge 3f+k runs from corner k of face f to the next corner.
struct EdgeSide {
  std::uint32_t upper_end;  ///< The higher vertex of the edge.
  std::uint32_t half_edge;

  friend auto operator<=>(const EdgeSide&, const EdgeSide&) = default;
};

/// Calls visit(std::span<const EdgeSide>) once for every undirected edge, with one element for
/// each of its faces, in ascending order of half-edges. Edges come in ascending order of (lower,
/// upper) end. Preconditions: indices below `vertex_count`, no face repeats a vertex, at most
/// kNoIndex / 3 faces. O(n log n), whatever the valences; 24 bytes a face and 4 a vertex.
template <class Visit>
void for_each_edge(std::span<const Triangle> triangles, std::uint32_t vertex_count, Visit visit) {
  const auto ends_of = [&](std::uint32_t h) {
    return std::minmax(triangles[h / 3][h % 3], triangles[h / 3][(h + 1) % 3]);
  };
  const auto half_edges = static_cast<std::uint32_t>(3 * triangles.size());

  // A counting sort by lower ends. Filling a group moves its start to its end.
  std::vector<std::uint32_t> group_ends(vertex_count, 0);
  for (std::uint32_t h = 0; h < half_edges; ++h) ++group_ends[ends_of(h).first];
  std::uint32_t start = 0;
  for (std::uint32_t& group : group_ends) start += std::exchange(group, start);
  std::vector<EdgeSide> sides(half_edges);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    const auto [lower, upper] = ends_of(h);
    sides[group_ends[lower]++] = {upper, h};
  }

  auto first = sides.begin();
  for (const std::uint32_t group_end : group_ends) {
    const auto end = sides.begin() + group_end;
    std::sort(first, end);
    while (first != end) {
      const auto last = std::find_if(
          first, end, [&](const EdgeSide& side) { return side.upper_end != first->upper_end; });
      visit(std::span<const EdgeSide>(first, last));
      first = last;
    }
  }
}

}  // namespace pmesh
