#include "core/metrics/memoryless.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/metrics/memoryless_lanes.h"

namespace pmesh {
namespace {

using namespace memoryless_lanes;
using Summary = Memoryless::Summary;

// Up to three planes that fix a position (section 3 of the paper).
class Constraints {
 public:
  int count() const { return count_; }

  // Adds normal . p = distance, if its normal is not nearly within the span of those before it.
  void add(Vec3d normal, double distance) {
    if (count_ == 3 || !is_independent(normal)) return;
    normals_[count_] = normal;
    distances_[count_++] = distance;
  }

  // Adds what makes `objective` least among the positions that the constraints leave.
  void add_least(const Quadric& objective) {
    const auto add_row = [&](Vec3d direction) {
      add(objective.times(direction), -dot(direction, objective.b));
    };
    if (count_ == 0) {
      for (const Vec3d axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) add_row(axis);
    } else if (count_ == 1) {
      const Vec3d n = normals_[0];
      const Vec3d first = cross(n, least_axis(n));
      add_row(first);
      add_row(cross(n, first));
    } else if (count_ == 2) {
      add_row(cross(normals_[0], normals_[1]));
    }
  }

  // Precondition: count() == 3.
  Vec3d solve() const {
    const Vec3d c0 = cross(normals_[1], normals_[2]), c1 = cross(normals_[2], normals_[0]),
                c2 = cross(normals_[0], normals_[1]);
    const double determinant = dot(normals_[0], c0);
    return 1 / determinant * (distances_[0] * c0 + distances_[1] * c1 + distances_[2] * c2);
  }

 private:
  bool is_independent(Vec3d n) const {
    const double length2 = dot(n, n);
    if (!(length2 > 0)) return false;
    if (count_ == 0) return true;
    if (count_ == 1) {
      const double along = dot(n, normals_[0]);
      return along * along < (1 - kSine2) * length2 * dot(normals_[0], normals_[0]);
    }
    const Vec3d plane = cross(normals_[0], normals_[1]);
    const double out = dot(n, plane);
    return out * out > kSine2 * length2 * dot(plane, plane);
  }

  std::array<Vec3d, 3> normals_;
  std::array<double, 3> distances_{};
  int count_ = 0;
};

// Squared lengths of the edges to the merged vertex, but for a constant.
Quadric shape_of(const PlacedEdge& edge, const Summary& a, const Summary& b) {
  const double count = a.neighbour_count + b.neighbour_count;
  const Vec3d sum = a.neighbours + b.neighbours + a.neighbour_count * edge.position_a +
                    b.neighbour_count * edge.position_b;
  return {{count, 0, 0, count, 0, count}, -1.0 * sum, 0};
}

// The border edges of a star.
struct StarBorder {
  Quadric areas;  // f_B: squared areas of the triangles of a place and the edges.
  Vec3d e1, e2;   // Twice the sum of their area vectors is p x e1 + e2.

  StarBorder(const PlacedEdge& edge, const Summary& a, const Summary& b) {
    if (edge.on_border) add(edge.position_a, edge.position_b);
    if (a.border) add(edge.position_a + a.previous, edge.position_a);
    if (a.border && !edge.on_border) add(edge.position_a, edge.position_a + a.next);
    if (b.border) add(edge.position_b, edge.position_b + b.next);
    if (b.border && !edge.on_border) add(edge.position_b + b.previous, edge.position_b);
  }

  void add(Vec3d from, Vec3d to) {
    areas += Quadric::squared_area(from, to);
    e1 += to - from;
    e2 += cross(to, from);
  }

  // Border preservation (section 4.2): the sum of the area vectors is least on the line of
  // direction e1 through `on_line`.
  void constrain(Constraints& constraints) const {
    const Vec3d on_line = -1 / dot(e1, e1) * cross(e1, e2);
    const Vec3d across = cross(e1, least_axis(e1)), upright = cross(e1, across);
    constraints.add(across, dot(across, on_line));
    constraints.add(upright, dot(upright, on_line));
  }
};

// At a border, or where volume and cost leave a direction open.
Placement place_with_care(const PlacedEdge& edge, const Summary& a, const Summary& b) {
  auto [cost, normal, distance] =
      star_volumes(edge.position_b, edge.left, edge.on_border ? Vec3d{} : edge.right, a.areas,
                   a.normal, b.areas, b.normal);
  Constraints constraints;
  if (a.border || b.border) {
    const StarBorder border(edge, a, b);
    const double length2 = 4 * dot(edge.position_b, edge.position_b);
    cost += border.areas.scaled((1 - kVolumeShare) / kVolumeFactor * length2);
    border.constrain(constraints);
  }
  constraints.add(normal, distance);
  constraints.add_least(cost);
  constraints.add_least(shape_of(edge, a, b));
  const Vec3d position = constraints.count() == 3 ? constraints.solve() : Vec3d{};
  return {std::max(0.0, kVolumeFactor * cost(position)), position};
}

Edges rows_of(std::span<const SummedEdge<Summary>> edges) {
  Edges rows;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [edge, a, b] = edges[i];
    rows.half.set(i, edge.position_b);
    rows.left.set(i, edge.left);
    rows.right.set(i, edge.right);
    rows.normal_a.set(i, a->normal);
    rows.normal_b.set(i, b->normal);
    rows.areas_a.set(i, a->areas);
    rows.areas_b.set(i, b->areas);
  }
  return rows;
}

// At most kBatch edges.
void place_batch(std::span<const SummedEdge<Summary>> edges, std::span<Placement> placements) {
  Places places;
  memoryless_lanes::place(rows_of(edges), edges.size(), places);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [edge, a, b] = edges[i];
    if (places.is_settled[i] != 0 && !a->border && !b->border) {
      placements[i] = {places.cost[i], places.position[i]};
    } else {
      placements[i] = place_with_care(edge, *a, *b);
    }
  }
}

}  // namespace

Summary Memoryless::summarise(const PlacedRing& ring) const {
  FaceSums sums;
  sum_faces(ring, sums);
  Summary summary{sums.areas, sums.normal, sums.seconds, double(ring.count), ring.border, {}, {}};
  if (ring.border) {
    summary.next = ring.neighbour(0);
    summary.previous = ring.neighbour(ring.count - 1);
    summary.neighbours += summary.next;  // of no face the second
  }
  return summary;
}

void Memoryless::place(std::span<const SummedEdge<Summary>> edges,
                       std::span<Placement> placements) const {
  assert(edges.size() == placements.size());
  for (std::size_t first = 0; first < edges.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, edges.size() - first);
    place_batch(edges.subspan(first, count), placements.subspan(first, count));
  }
}

}  // namespace pmesh
