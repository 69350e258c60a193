#include "core/metrics/triangle_collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/decimate/face_turn.h"

namespace pmesh {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

}  // namespace

TriangleCollapse::TriangleCollapse(double planarity)
    : planarity_(planarity), planar_cosine_(-std::cos(radians(planarity))) {
  for (std::uint32_t round = 0; round + 1 < kRounds; ++round) {
    least_cosines_[round] = std::cos(radians(1 << round));
  }
}

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
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d from = star.positions[(k + 2) % 3];
    const Vec3d side = star.positions[(k + 1) % 3] - from, other_side = star.apexes[k] - from;
    const Vec3d across = cross(side, other_side);
    if (!has_area(across, side, other_side)) continue;
    if (!(dot(normal, across) > planar_cosine_ * length(normal) * length(across))) return false;
  }
  return true;
}

}  // namespace pmesh
