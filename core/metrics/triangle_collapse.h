// Triangle collapse: S. K. Ali, R. Wirza, F. Khalid and N. S. Beng, "Mesh simplification - a new
// approach", Jurnal Teknologi 56 (2011). As published, see
// docs/decisions/0010-triangle-collapse-as-published.md for what the paper leaves open.
#pragma once

#include <array>
#include <string_view>

#include "core/decimate/triangle_metric.h"

namespace pmesh {

/// Collapses the triangle whose big triangle (see triangle_metric.h) is flattest for its area,
/// among those that are nearly coplanar with their neighbours.
class TriangleCollapse {
 public:
  static constexpr std::string_view kName = "triangle";
  static constexpr double kDefaultPlanarity = 165;

  /// In round r no face turns by more than 2^r degrees, in the last by more than 90; up to 16
  /// degrees the planar test holds.
  static constexpr std::uint32_t kRounds = 8;
  static constexpr std::uint32_t kPlanarRounds = 5;

  /// The least angle between a triangle and its neighbours, in degrees; 180: they are coplanar.
  explicit TriangleCollapse(double planarity = kDefaultPlanarity);

  double planarity() const { return planarity_; }

  /// Equation 10: the distance of the six vertices' mean from the plane of the apexes, over the
  /// area of the apexes' triangle. If that has no area, the greatest number: such triangles come
  /// last.
  double cost(const TriangleStar& star) const;

  /// The planar test (section 3.5). A triangle without area fails, a neighbour without area does
  /// not count.
  bool is_planar(const TriangleStar& star) const;

  /// The self-intersection test (section 3.7).
  double least_cosine(std::uint32_t round) const { return least_cosines_[round]; }

 private:
  double planarity_;
  double planar_cosine_;  // of the angle between two normals
  std::array<double, kRounds> least_cosines_{};
};

static_assert(TriangleMetric<TriangleCollapse>);

}  // namespace pmesh
