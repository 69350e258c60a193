#include "core/precompute/sort_spatially.h"

#include <algorithm>

#include "core/base/box.h"
#include "core/measure/spatial_order.h"

namespace pmesh {
namespace {

// The positions in the cube [-1, 1]^3.
std::vector<Vec3d> in_unit_cube(const std::vector<Vec3d>& positions) {
  const Box<double> box = bounding_box(std::span(positions));
  const double side = box.longest_side();
  const double scale = side > 0 ? 2 / side : 0;
  std::vector<Vec3d> points;
  points.reserve(positions.size());
  for (const Vec3d p : positions) points.push_back(scale * (p - box.low) + Vec3d{-1, -1, -1});
  return points;
}

void sort_vertices(IndexedMesh& mesh, unsigned threads) {
  const std::vector<std::uint32_t> order = spatial_order(in_unit_cube(mesh.positions), threads);
  std::vector<Vec3d> positions;
  std::vector<std::uint32_t> new_index(order.size());
  positions.reserve(order.size());
  for (const std::uint32_t v : order) {
    new_index[v] = static_cast<std::uint32_t>(positions.size());
    positions.push_back(mesh.positions[v]);
  }
  mesh.positions = std::move(positions);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = new_index[corner];
  }
}

// A counting sort, which keeps the order of faces with the same least vertex.
void sort_faces(IndexedMesh& mesh) {
  const auto least = [](const Triangle& t) { return std::min({t[0], t[1], t[2]}); };
  std::vector<std::uint32_t> next(mesh.positions.size() + 1);
  for (const Triangle& t : mesh.triangles) ++next[least(t) + 1];
  for (std::size_t v = 1; v < next.size(); ++v) next[v] += next[v - 1];
  std::vector<Triangle> sorted(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) sorted[next[least(t)]++] = t;
  mesh.triangles = std::move(sorted);
}

}  // namespace

void sort_spatially(IndexedMesh& mesh, unsigned threads) {
  if (mesh.positions.empty()) return;
  sort_vertices(mesh, threads);
  sort_faces(mesh);
}

}  // namespace pmesh
