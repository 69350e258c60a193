#include "core/metrics/triangle_collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/decimate/face_turn.h"

namespace pmesh {

TriangleCollapse::TriangleCollapse(double planarity)
    : planarity_(planarity), least_cosine_(-std::cos(planarity * std::numbers::pi / 180)) {}

double TriangleCollapse::cost(const TriangleStar& star) const {
  constexpr double kLast = std::numeric_limits<double>::max();
  const auto& [v0, v1, v2] = star.apexes;
  const auto& [v3, v4, v5] = star.positions;
  const Vec3d side = v1 - v0, other_side = v2 - v0;
  const Vec3d doubled = cross(side, other_side);
  if (!has_area(doubled, side, other_side)) return kLast;
  const double doubled_area = length(doubled);
  const Vec3d centre = 1.0 / 6 * (v0 + v1 + v2 + v3 + v4 + v5);                // equation 1
  const double distance = std::abs(dot(doubled, centre - v0)) / doubled_area;  // 8 and 9
  return std::min(kLast, distance / (0.5 * doubled_area));
}

bool TriangleCollapse::is_planar(const TriangleStar& star) const {
  const auto& [a, b, c] = star.positions;
  const Vec3d normal = cross(b - a, c - a);
  if (!has_area(normal, b - a, c - a)) return false;
  const double least = least_cosine_ * length(normal);
  return std::all_of(star.faces.begin(), star.faces.end(), [&](const TriangleStar::Face& face) {
    const Vec3d side = face.second - face.corner, other_side = face.third - face.corner;
    const Vec3d around = cross(side, other_side);
    return !has_area(around, side, other_side) || dot(normal, around) > least * length(around);
  });
}

}  // namespace pmesh
