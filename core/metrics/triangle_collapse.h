// Triangle collapse: S. K. Ali, R. Wirza, F. Khalid and N. S. Beng, "Mesh simplification - a new
// approach", Jurnal Teknologi 56 (2011). As published, see
// docs/decisions/0010-triangle-collapse-as-published.md for what the paper leaves open.
#pragma once

#include <string_view>

#include "core/decimate/triangle_star.h"

namespace pmesh {

/// Collapses the triangle whose big triangle (see triangle_star.h) is flattest for its area, as
/// long as it is nearly coplanar with all faces around it.
class TriangleCollapse {
 public:
  static constexpr std::string_view kName = "triangle";
  static constexpr double kDefaultPlanarity = 165;

  /// The least angle between the triangle and a face around it, in degrees: 180 if they are
  /// coplanar; with 0 the test always passes.
  explicit TriangleCollapse(double planarity = kDefaultPlanarity);

  double planarity() const { return planarity_; }

  /// Equation 10: the distance of the six vertices' mean from the plane of the apexes, over the
  /// area of the apexes' triangle. If that has no area, the greatest number: such triangles come
  /// last.
  double cost(const TriangleStar& star) const;

  /// The planar test (section 3.5), over all faces that share a corner with the triangle. A
  /// triangle without area fails; a face around it without area does not count.
  bool is_planar(const TriangleStar& star) const;

 private:
  double planarity_;
  double least_cosine_;  // of the angle between two normals
};

static_assert(TriangleMetric<TriangleCollapse>);

}  // namespace pmesh
