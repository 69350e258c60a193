#include "core/io/weld.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/mesh/edge_groups.h"

namespace pmesh {
namespace {

std::vector<std::uint32_t> candidates(const IndexedMesh& mesh, WeldScope scope) {
  const auto vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<std::uint32_t> vertices;
  if (scope == WeldScope::all_vertices) {
    vertices.resize(vertex_count);
    std::iota(vertices.begin(), vertices.end(), 0);
    return vertices;
  }
  for_each_edge(mesh.triangles, vertex_count, [&](std::span<const EdgeSide> sides) {
    if (sides.size() != 1) return;
    const std::uint32_t h = sides[0].half_edge;
    vertices.push_back(mesh.triangles[h / 3][h % 3]);
    vertices.push_back(mesh.triangles[h / 3][(h + 1) % 3]);
  });
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// x beside the index spares most comparisons a look at the positions.
struct PlacedVertex {
  double x;
  std::uint32_t vertex;
};

}  // namespace

std::uint64_t weld_vertices(IndexedMesh& mesh, WeldScope scope) {
  const auto place = [&](const PlacedVertex& v) {
    const Vec3d& p = mesh.positions[v.vertex];
    return std::tuple(p.y, p.z);
  };
  const std::vector<std::uint32_t> vertices = candidates(mesh, scope);
  std::vector<PlacedVertex> placed;
  placed.reserve(vertices.size());
  for (const std::uint32_t v : vertices) placed.push_back({mesh.positions[v].x, v});
  std::sort(placed.begin(), placed.end(), [&](const PlacedVertex& a, const PlacedVertex& b) {
    if (a.x != b.x) return a.x < b.x;
    const auto place_a = place(a), place_b = place(b);
    return place_a != place_b ? place_a < place_b : a.vertex < b.vertex;
  });

  std::vector<std::uint32_t> survivors(mesh.positions.size());
  std::iota(survivors.begin(), survivors.end(), 0);
  std::uint64_t welded = 0;
  for (std::size_t i = 1; i < placed.size(); ++i) {
    const std::uint32_t v = placed[i].vertex, before = placed[i - 1].vertex;
    if (mesh.positions[v] != mesh.positions[before]) continue;
    survivors[v] = survivors[before];
    ++welded;
  }
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = survivors[v];
  }
  return welded;
}

}  // namespace pmesh
