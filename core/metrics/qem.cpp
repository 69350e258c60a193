#include "core/metrics/qem.h"

#include <algorithm>
#include <initializer_list>

#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

// A border edge counts as a face upright on it, of its squared length, with this weight.
constexpr double kBorderWeight = 1000;

// Where the quadric is flat in some direction, the least place in that direction is undetermined:
// it is drawn to the edge's midpoint by a spring of this share of the quadric's trace.
constexpr double kSpring = 1e-6;

// Each part of the vertices looks at all faces: more would not pay.
constexpr std::uint32_t kMaxParts = 8;

}  // namespace

void QuadricField::start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions,
                         const MetricFrame& frame, unsigned threads) {
  quadrics_.assign(mesh.vertex_slots(), {});
  const std::uint32_t parts = std::min(threads, kMaxParts);
  const std::uint32_t part = mesh.vertex_slots() / parts + 1;
  for_blocks<1>(parts, threads, [&](std::uint32_t i, std::uint32_t) {
    add_planes(mesh, positions, frame, i * part, part);
  });
}

void QuadricField::add_planes(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions,
                              const MetricFrame& frame, std::uint32_t first_vertex,
                              std::uint32_t vertices) {
  const auto is_ours = [&](VertexId v) { return v.value - first_vertex < vertices; };
  const auto at = [&](VertexId v) { return frame.to_unit(positions[v.value]); };
  const auto add_plane = [&](Vec3d normal, Vec3d point, double weight,
                             std::initializer_list<VertexId> corners) {
    const Quadric q = Quadric::plane(normal, -dot(normal, point), weight);
    for (const VertexId v : corners) {
      if (is_ours(v)) quadrics_[v.value] += q;
    }
  };
  for (std::uint32_t f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.is_live(FaceId(f))) continue;
    const VertexId a = mesh.corners()[3 * f], b = mesh.corners()[3 * f + 1],
                   c = mesh.corners()[3 * f + 2];
    if (!is_ours(a) && !is_ours(b) && !is_ours(c)) continue;
    const Vec3d doubled = cross(at(b) - at(a), at(c) - at(a));
    const double area = 0.5 * length(doubled);
    if (!(area > 0)) continue;
    const Vec3d normal = 0.5 / area * doubled;
    add_plane(normal, at(a), area, {a, b, c});
    for (std::uint32_t k = 0; k < 3; ++k) {
      const HalfEdgeId h(3 * f + k);
      if (!mesh.is_border(h)) continue;
      const VertexId from = mesh.origin(h), to = mesh.target(h);
      const Vec3d edge = at(to) - at(from);
      const double edge_length = length(edge);
      if (!(edge_length > 0)) continue;
      add_plane(1 / edge_length * cross(edge, normal), at(from),
                kBorderWeight * edge_length * edge_length, {from, to});
    }
  }
}

double QemSubset::cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
                       const MovedFaces& /*moved*/) const {
  const double of_head = quadrics_[ring.ids[head]](ring.origin + ring.position(head));
  return floor(ring, prepared, head) + std::max(0.0, of_head);
}

double QemSubset::floor(const OneRing& ring, const Prepared& prepared, std::uint32_t head) const {
  return std::max(0.0, prepared.centre(ring.position(head)));
}

Placement QemSolved::place(const EdgeStar& star) const {
  const Quadric q = (quadrics_[star.a] + quadrics_[star.b]).relative_to(star.origin);
  const Vec3d least = q.least(kSpring);
  Placement best{kRefused, {}};
  for (const Vec3d candidate : {least, Vec3d{}, star.position_a, star.position_b}) {
    const double cost = std::max(0.0, q(candidate));
    if (cost < best.cost) best = {cost, candidate};
  }
  return best;
}

}  // namespace pmesh
