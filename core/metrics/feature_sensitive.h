#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/decimate/edge_star.h"
#include "core/metrics/quadric6.h"

namespace pmesh {

class FeatureSensitive {
 public:
  static constexpr std::string_view kName = "feature-sensitive";
  static constexpr EdgeReach kReach = EdgeReach::merged;
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

  const Quadric6& quadric(VertexId v) const { return quadrics_[v.value]; }
  Vec3d normal(VertexId v) const { return normals_[v.value]; }
  double blow_up_weight(VertexId v) const { return blow_up_ ? blow_up_weights_[v.value] : 1; }

 private:
  Vec3d middle_normal(const EdgeStar& star) const;
  double merged_weight(const EdgeStar& star) const;

  double weight_;
  bool blow_up_;
  double unit_weight_ = 0;  // weight_ in the unit frame
  std::vector<Quadric6> quadrics_;
  std::vector<Vec3d> normals_;           // unit, or zero
  std::vector<double> blow_up_weights_;  // only if blow_up_
};

static_assert(EdgeMetric<FeatureSensitive>);

}  // namespace pmesh
