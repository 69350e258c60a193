#include "core/measure/compare.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/measure/distance_bound.h"
#include "core/measure/sampling.h"
#include "core/measure/surface.h"

namespace pmesh {
namespace {

// A maximum found is short of the true one by this fraction at most.
constexpr double kMaxTolerance = 0.02;

Box<double> joined(const Box<double>& a, const Box<double>& b) {
  const std::array<Vec3d, 4> ends = {a.low, a.high, b.low, b.high};
  return bounding_box(std::span<const Vec3d>(ends));
}

// What is but rounding counts as nothing.
SurfaceDistance in_lengths(const SurfaceDistance& unit, const UnitFrame& frame) {
  if (unit.max <= kNoDistance) return {};
  return {frame.to_length(unit.max), frame.to_length(unit.mean), frame.to_length(unit.rms)};
}

// In unit lengths.
SurfaceDistance distance_from(const Surface& source, const Surface& target,
                              const CompareOptions& options) {
  using Over = SurfaceSampler::Over;
  const std::uint32_t on_edges = options.samples / 4, on_faces = options.samples - on_edges;
  const SurfaceSampler faces(source, Over::faces, on_faces, 2 * options.seed);
  const SurfaceSampler edges(source, Over::edges, on_edges, 2 * options.seed + 1);
  const SurfaceDistance over_faces = sampled_distance(source, faces, target, options.threads);
  const SurfaceDistance over_edges = sampled_distance(source, edges, target, options.threads);
  const SurfaceDistance over_vertices = vertex_distance(source, target, options.threads);

  DistanceBound farthest(source, target, kMaxTolerance, options.threads);
  farthest.reach(std::max({over_faces.max, over_edges.max, over_vertices.max}));
  farthest.find();

  // A surface without area is but its edges.
  SurfaceDistance distance = faces.count() > 0 ? over_faces : over_edges;
  distance.max = farthest.reached();
  return distance;
}

}  // namespace

Result<Comparison> compare_surfaces(const IndexedMesh& a, const IndexedMesh& b,
                                    const CompareOptions& options) {
  if (a.triangles.empty() || b.triangles.empty()) return bad_input("a mesh has no triangle");
  const MeshView view_a{a.positions, a.triangles}, view_b{b.positions, b.triangles};
  const Box<double> box_a = box_of_faces(view_a);
  const Result<UnitFrame> frame = unit_frame(joined(box_a, box_of_faces(view_b)));
  if (!frame) return frame.error();
  const Surface surface_a(view_a, *frame, options.threads);
  const Surface surface_b(view_b, *frame, options.threads);

  Comparison comparison;
  comparison.bbox_diagonal = frame->to_length(length(frame->scale * (box_a.high - box_a.low)));
  comparison.forward = in_lengths(distance_from(surface_a, surface_b, options), *frame);
  comparison.backward = in_lengths(distance_from(surface_b, surface_a, options), *frame);
  return comparison;
}

}  // namespace pmesh
