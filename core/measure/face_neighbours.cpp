#include "core/measure/face_neighbours.h"

#include <algorithm>

#include "core/base/ids.h"

namespace pmesh {
namespace {

// The edge k of a face, from its lower vertex to its higher.
struct Edge {
  std::uint32_t low, high;
};

Edge edge_of(const Triangle& t, std::size_t k) {
  const std::uint32_t from = t[k], to = t[k == 2 ? 0 : k + 1];
  return {std::min(from, to), std::max(from, to)};
}

struct FaceEdge {
  std::uint32_t high;
  std::uint32_t face;
  std::uint32_t k;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> face_neighbours(std::span<const Triangle> triangles,
                                                          std::uint32_t vertex_count) {
  // All edges in groups of the same lower vertex, which are few each.
  std::vector<std::uint32_t> group_end(vertex_count + 1, 0);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++group_end[edge_of(t, k).low + 1];
  }
  for (std::uint32_t v = 0; v < vertex_count; ++v) group_end[v + 1] += group_end[v];
  std::vector<FaceEdge> edges(3 * triangles.size());
  for (std::uint32_t face = 0; face < triangles.size(); ++face) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Edge edge = edge_of(triangles[face], k);
      edges[group_end[edge.low]++] = {edge.high, face, k};
    }
  }
  std::vector<std::array<std::uint32_t, 3>> neighbours(triangles.size(),
                                                       {kNoIndex, kNoIndex, kNoIndex});
  std::uint32_t begin = 0;
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    const auto group = std::span(edges).subspan(begin, group_end[v] - begin);
    std::sort(group.begin(), group.end(), [](const FaceEdge& a, const FaceEdge& b) {
      return a.high != b.high ? a.high < b.high : a.face < b.face;
    });
    for (std::size_t i = 1; i < group.size(); ++i) {
      const FaceEdge &a = group[i - 1], &b = group[i];
      if (a.high != b.high) continue;
      if (neighbours[a.face][a.k] == kNoIndex) neighbours[a.face][a.k] = b.face;
      neighbours[b.face][b.k] = a.face;
    }
    begin = group_end[v];
  }
  return neighbours;
}

}  // namespace pmesh
