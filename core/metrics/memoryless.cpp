#include "core/metrics/memoryless.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/metrics/quadric.h"

namespace pmesh {
namespace {

// The paper's lambda: how volumes and border areas share in the cost.
constexpr double kVolumeShare = 0.5;

// The squared volume of the tetrahedron between a face and p: the face's doubled area vector n is
// six times as long per unit of height as the volume.
void add_volume(Vec3d doubled_area, Vec3d on_face, Quadric& sum) {
  sum += Quadric::plane(doubled_area, -dot(doubled_area, on_face), 1.0 / 36);
}

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

// What the paper sums up over a star.
struct Sums {
  Quadric volumes;       // f_V
  Vec3d normal;          // of doubled areas
  double distance = 0;   // volume preservation: normal . p = distance
  Quadric border_areas;  // f_B
  Vec3d border_e1, border_e2;
  Quadric shape;  // squared lengths of the edges to the merged vertex
};

void add_face(Vec3d a, Vec3d b, Vec3d c, Sums& sums) {
  const Vec3d n = cross(b - a, c - a);
  add_volume(n, a, sums.volumes);
  sums.normal += n;
  sums.distance += dot(n, a);
}

void add_neighbour(Vec3d p, Sums& sums) {
  Quadric& q = sums.shape;
  q.xx += 1, q.yy += 1, q.zz += 1;
  q.b += -1.0 * p;
  q.c += dot(p, p);
}

Sums sum_up(const EdgeStar& star) {
  Sums sums;
  for (const EdgeStar::Face& face : star.faces) {
    add_face(face.end, face.second, face.third, sums);
    add_neighbour(face.second, sums);
    add_neighbour(face.third, sums);
  }
  add_face(star.position_a, star.position_b, star.apexes[0], sums);
  if (!star.on_border()) add_face(star.position_b, star.position_a, star.apexes[1], sums);
  for (const EdgeStar::BorderEdge& edge : star.borders) {
    sums.border_areas += Quadric::squared_area(edge.from, edge.to);
    sums.border_e1 += edge.to - edge.from;
    sums.border_e2 += cross(edge.to, edge.from);
  }
  return sums;
}

}  // namespace

Placement Memoryless::place(const EdgeStar& star) const {
  const Sums sums = sum_up(star);
  const double length2 = 4 * dot(star.position_b, star.position_b);
  Quadric objective = sums.volumes.scaled(kVolumeShare);
  objective += sums.border_areas.scaled((1 - kVolumeShare) * length2);

  Constraints constraints;
  if (dot(sums.border_e1, sums.border_e1) > 0) {
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
  constraints.add_least(sums.shape);
  const Vec3d position = constraints.count() == 3 ? constraints.solve() : Vec3d{};
  return {std::max(0.0, objective(position)), position};
}

}  // namespace pmesh
