#include "core/metrics/memoryless.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pmesh {
namespace {

// The paper's lambda: how volumes and border areas share in the cost.
constexpr double kVolumeShare = 0.5;

// The axis that makes the largest angle with n.
Vec3d least_axis(Vec3d n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  if (x <= y && x <= z) return {1, 0, 0};
  return y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
}

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
  // The paper's angle of one degree.
  static constexpr double kSine2 = 3.0458648e-4, kCosine2 = 1 - kSine2;

  bool is_independent(Vec3d n) const {
    const double length2 = dot(n, n);
    if (!(length2 > 0)) return false;
    if (count_ == 0) return true;
    if (count_ == 1) {
      const double along = dot(n, normals_[0]);
      return along * along < kCosine2 * length2 * dot(normals_[0], normals_[0]);
    }
    const Vec3d plane = cross(normals_[0], normals_[1]);
    const double out = dot(n, plane);
    return out * out > kSine2 * length2 * dot(plane, plane);
  }

  std::array<Vec3d, 3> normals_;
  std::array<double, 3> distances_{};
  int count_ = 0;
};

Quadric shape_of(const Memoryless::Summary& sums) {
  Quadric shape;  // squared lengths of the edges to the merged vertex, but for a constant
  shape.xx = shape.yy = shape.zz = sums.neighbour_count;
  shape.b = -1.0 * sums.neighbours;
  return shape;
}

}  // namespace

// The volume is a sixth of the height over the doubled area, times that area.
void Memoryless::Summary::add_face(Vec3d a, Vec3d b, Vec3d c, double sign) {
  const Vec3d n = cross(b - a, c - a);
  const double d = dot(n, a);
  volumes += Quadric::plane(n, -d, sign / 36);
  normal += sign * n;
  distance += sign * d;
}

void Memoryless::Summary::add_border(Vec3d from, Vec3d to, double sign) {
  border = true;
  border_areas += Quadric::squared_area(from, to).scaled(sign);
  border_e1 += sign * (to - from);
  border_e2 += sign * cross(to, from);
}

void Memoryless::Summary::add(const Summary& other) {
  volumes += other.volumes;
  normal += other.normal;
  distance += other.distance;
  neighbours += other.neighbours;
  neighbour_count += other.neighbour_count;
  if (!other.border) return;
  border = true;
  border_areas += other.border_areas;
  border_e1 += other.border_e1;
  border_e2 += other.border_e2;
}

Memoryless::Summary Memoryless::Summary::relative_to(Vec3d origin) const {
  Summary moved = *this;
  moved.volumes = volumes.relative_to(origin);
  moved.distance -= dot(normal, origin);
  moved.neighbours += -neighbour_count * origin;
  if (!border) return moved;
  moved.border_areas = border_areas.relative_to(origin);
  moved.border_e2 += cross(origin, border_e1);
  return moved;
}

Memoryless::Summary Memoryless::summarise(const PlacedRing& ring) const {
  Summary sums;
  for (std::uint32_t i = 0; i < ring.faces; ++i) {
    sums.add_face(ring.centre, ring.neighbours[i], ring.after(i), 1);
  }
  for (std::uint32_t i = 0; i < ring.count; ++i) sums.neighbours += ring.neighbours[i];
  sums.neighbour_count = ring.count;
  sums.border = ring.border;
  if (ring.border) {
    sums.add_border(ring.centre, ring.neighbours[0], 1);
    sums.add_border(ring.neighbours[ring.count - 1], ring.centre, 1);
  }
  return sums;
}

Placement Memoryless::place(const EdgeStar& star, const Summary& a, const Summary& b) const {
  Summary both = a;
  both.add(b);
  Summary sums = both.relative_to(star.origin);  // and the edge and its faces were added twice
  sums.add_face(star.position_a, star.position_b, star.left, -1);
  if (star.on_border) {
    sums.add_border(star.position_a, star.position_b, -1);
  } else {
    sums.add_face(star.position_b, star.position_a, star.right, -1);
  }
  const double length2 = 4 * dot(star.position_b, star.position_b);
  Quadric objective = sums.volumes.scaled(kVolumeShare);
  if (sums.border) objective += sums.border_areas.scaled((1 - kVolumeShare) * length2);

  Constraints constraints;
  if (sums.border) {
    // Border preservation (section 4.2): the sum of the area vectors, (p x e1 + e2) / 2, is least
    // on the line of direction e1 through `on_line`.
    const Vec3d e1 = sums.border_e1;
    const Vec3d on_line = -1 / dot(e1, e1) * cross(e1, sums.border_e2);
    const Vec3d across = cross(e1, least_axis(e1)), upright = cross(e1, across);
    constraints.add(across, dot(across, on_line));
    constraints.add(upright, dot(upright, on_line));
  }
  constraints.add(sums.normal, sums.distance);  // volume preservation (section 4.1)
  constraints.add_least(objective);
  constraints.add_least(shape_of(sums));
  const Vec3d position = constraints.count() == 3 ? constraints.solve() : Vec3d{};
  return {std::max(0.0, objective(position)), position};
}

}  // namespace pmesh
