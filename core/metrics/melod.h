// MELOD: M. Hussain, Y. Okada and K. Niijima, "Efficient and feature-preserving triangular mesh
// decimation", Journal of WSCG 12 (2004). As published, see
// docs/decisions/0004-melod-as-published.md for what the paper leaves open.
#pragma once

#include <string_view>

#include "core/decimate/metric.h"

namespace pmesh {

class Melod {
 public:
  static constexpr std::string_view kName = "melod";
  static constexpr RingGeometry kGeometry = RingGeometry::moved_faces;
  static constexpr bool kInheritsKeys = true;
  static constexpr double kDefaultLambda = 10;

  /// `lambda` weighs the preservation of borders; the paper uses 1 to 50.
  explicit Melod(double lambda = kDefaultLambda) : lambda_(lambda) {}

  double lambda() const { return lambda_; }

  struct Prepared {
    double importance;
  };
  Prepared prepare(const OneRing& ring) const { return {importance(ring)}; }

  /// The cost of a half-edge collapse (section 3): the sum over the moved faces of
  /// 0.5 (area + area') (1 - n . n'), and along a border lambda phi |v1 - v2| on top.
  double cost(const OneRing& ring, Prepared, std::uint32_t head, const MovedFaces& moved) const;

  /// Section 4, step 3: the greater of the cost and the popped key, times the visual importance.
  double priority(Prepared centre, double cost, double popped) const {
    return centre.importance * (cost < popped ? popped : cost);
  }

  /// There is no geometric history.
  void start(const HalfEdgeMesh&, std::span<const Vec3d>, const MetricFrame&, unsigned = 1) {}
  void prefetch(VertexId) const {}
  void fold(VertexId /*removed*/, VertexId /*kept*/) {}
  void renumber(const CompactIds& /*ids*/) {}

  /// The visual importance w = 1 - |k| of the ring's centre, k being the area-weighted mean of its
  /// faces' unit normals: 0 on a flat surface, at most 1. 0 if the faces have no area.
  static double importance(const OneRing& ring);

  /// phi = 1 - u21 . u23 for the collapse of the ring's centre, v1, into neighbour `head`, v2,
  /// along a border that goes on to v3.
  static double border_turn(const OneRing& ring, std::uint32_t head);

 private:
  double lambda_;
};

static_assert(HalfEdgeMetric<Melod>);

}  // namespace pmesh
