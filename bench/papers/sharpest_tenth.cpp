// Where the faces of levels of detail are: which share of them lies in the most curved tenth of the
// original's surface.
//
//   papers_sharpest_tenth ORIGINAL LOD...
//
// A vertex's curvature is the sum of length times dihedral angle over its edges, divided by the
// area of its faces; a face's is the mean of its corners'. The most curved faces that make up a
// tenth of the area are that tenth. A face of an LOD lies in it if the face of the original that is
// nearest to its centroid does. Prints a JSON array: a share for each LOD.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bench/papers/mesh_file.h"
#include "core/measure/surface.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh::bench {
namespace {

Vec3d doubled_area_vector(const IndexedMesh& mesh, const Triangle& t) {
  return cross(mesh.positions[t[1]] - mesh.positions[t[0]],
               mesh.positions[t[2]] - mesh.positions[t[0]]);
}

double angle(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

std::vector<double> vertex_curvatures(const IndexedMesh& mesh) {
  const auto built =
      HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
  if (!built) fail(built.error().message);
  std::vector<double> turn(mesh.positions.size()), area(mesh.positions.size());
  for (std::uint32_t face = 0; face < mesh.triangles.size(); ++face) {
    const Triangle& t = mesh.triangles[face];
    const Vec3d normal = doubled_area_vector(mesh, t);
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      area[t[corner]] += length(normal) / 2;
      const HalfEdgeId twin = built->twin(HalfEdgeId{3 * face + corner});
      if (!twin.valid()) continue;
      const Vec3d beyond = doubled_area_vector(mesh, mesh.triangles[twin.value / 3]);
      const Vec3d edge = mesh.positions[t[(corner + 1) % 3]] - mesh.positions[t[corner]];
      // Its other half-edge adds as much to its other end.
      turn[t[corner]] += length(edge) * angle(normal, beyond);
    }
  }
  for (std::size_t v = 0; v < turn.size(); ++v) turn[v] = area[v] > 0 ? turn[v] / area[v] : 0;
  return turn;
}

// By face of `mesh`: whether it is of the most curved tenth.
std::vector<bool> sharpest_tenth(const IndexedMesh& mesh) {
  const std::vector<double> of_vertex = vertex_curvatures(mesh);
  std::vector<double> curvature, area;
  for (const Triangle& t : mesh.triangles) {
    curvature.push_back(of_vertex[t[0]] + of_vertex[t[1]] + of_vertex[t[2]]);
    area.push_back(length(doubled_area_vector(mesh, t)));
  }
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return curvature[a] > curvature[b]; });
  const double tenth = std::accumulate(area.begin(), area.end(), 0.0) / 10;
  std::vector<bool> sharp(order.size());
  double sum = 0;
  for (std::size_t i = 0; i < order.size() && sum < tenth; ++i) {
    sharp[order[i]] = true;
    sum += area[order[i]];
  }
  return sharp;
}

double share_in(const std::vector<bool>& sharp, const Surface& original, const UnitFrame& frame,
                const IndexedMesh& lod) {
  std::uint32_t nearest = 0;
  double count = 0;
  for (const Triangle& t : lod.triangles) {
    const Vec3d sum = lod.positions[t[0]] + lod.positions[t[1]] + lod.positions[t[2]];
    nearest = original.nearest(frame.to_unit(1.0 / 3 * sum), nearest).face;
    if (sharp[original.given_face(nearest)]) ++count;
  }
  return count / static_cast<double>(lod.triangles.size());
}

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh;
  if (argc < 3) bench::fail("usage: papers_sharpest_tenth ORIGINAL LOD...");
  const IndexedMesh mesh = bench::load_clean(argv[1]);
  const std::vector<bool> sharp = bench::sharpest_tenth(mesh);
  const MeshView view{mesh.positions, mesh.triangles};
  const Result<UnitFrame> frame = unit_frame(box_of_faces(view));
  if (!frame) bench::fail(frame.error().message);
  const Surface original(view, *frame, 1);
  for (int i = 2; i < argc; ++i) {
    const double share = bench::share_in(sharp, original, *frame, bench::load_clean(argv[i]));
    std::printf("%s%.6f", i == 2 ? "[" : ", ", share);
  }
  std::printf("]\n");
}
