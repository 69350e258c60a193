// Feature-sensitive simplification: J. Wei and Y. Lou, "Feature preserving mesh simplification
// using feature sensitive metric", Journal of Computer Science and Technology 25(3), 2010. A vertex
// is a point (p, w n) of six dimensions, position and weighted normal; it carries the sum of the
// squared distances to the planes of its input faces there (equations 1 to 8). A collapse costs
// what the two ends' sums add up to at its target.
//
// - The target (section 3.3) has the least error under the constraint that the faces around it give
//   its normal: the position is solved for with the ends' mean normal, then with the normal of the
//   faces, at most four times, each with a line search that never lets the error rise.
// - On borders (section 4.2) the search goes along the border line.
// - With `blow_up` (section 4.1, blow_up.h) a collapse costs that many times more as its ends stand
//   for points; the target is the same.
// - A target that turns a face over costs three times as much (section 4.2). The engine refuses it
//   besides, until nothing else is left.
//
// The paper's optional post-cleaning, which flips edges of nearly degenerate faces (equation 11),
// is not here: a progressive mesh has vertex splits only. See docs/decisions/
// 0009-feature-sensitive-as-published.md for what the paper leaves open.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/decimate/edge_metric.h"
#include "core/metrics/quadric6.h"

namespace pmesh {

/// State by vertex: a quadric, a normal, and with `blow_up` a weight.
class FeatureSensitive {
 public:
  static constexpr std::string_view kName = "feature-sensitive";
  static constexpr bool kNeedsStar = true;
  static constexpr double kDefaultWeight = 0.03;

  /// `weight` is the paper's w: how long a unit normal is, the mesh's longest side being 1.
  explicit FeatureSensitive(double weight = kDefaultWeight, bool blow_up = false)
      : weight_(weight), blow_up_(blow_up) {}

  double weight() const { return weight_; }
  bool blow_up() const { return blow_up_; }

  void start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame);
  Placement place(const EdgeStar& star) const;
  void fold(const EdgeStar& star, VertexId removed, VertexId kept, Vec3d position);

  // What start() and fold() have made of a vertex.
  const Quadric6& quadric(VertexId v) const { return quadrics_[v.value]; }
  /// Unit, or zero if no face of the vertex has an area.
  Vec3d normal(VertexId v) const { return normals_[v.value]; }
  /// The paper's eta.
  double blow_up_weight(VertexId v) const { return blow_up_ ? blow_up_weights_[v.value] : 1; }

 private:
  Vec3d middle_normal(const EdgeStar& star) const;
  double merged_weight(const EdgeStar& star) const;

  double weight_;
  bool blow_up_;
  double unit_weight_ = 0;  // weight_ in the unit frame
  std::vector<Quadric6> quadrics_;
  std::vector<Vec3d> normals_;
  std::vector<double> blow_up_weights_;  // only if blow_up_
};

static_assert(EdgeMetric<FeatureSensitive>);

}  // namespace pmesh
