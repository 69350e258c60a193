// Memoryless simplification: P. Lindstrom and G. Turk, "Fast and memory efficient polygonal
// simplification", IEEE Visualization 1998. The cost of a collapse is the sum of the squared
// volumes that it sweeps, each tetrahedron between a face before it and the merged vertex, and
// along borders of the squared areas; no vertex carries any history.
#pragma once

#include <string_view>

#include "core/decimate/edge_star.h"

namespace pmesh {

/// The merged vertex is placed by volume and border preservation, then by the least cost, then by
/// the shape of its faces.
class Memoryless {
 public:
  static constexpr std::string_view kName = "memoryless";
  static constexpr EdgeReach kReach = EdgeReach::ring;
  static constexpr bool kNeedsStar = true;

  void start(const HalfEdgeMesh&, std::span<const Vec3d>, const MetricFrame&) {}
  Placement place(const EdgeStar& star) const;
  void fold(const EdgeStar&, VertexId /*removed*/, VertexId /*kept*/, Vec3d /*position*/) {}
};

static_assert(EdgeMetric<Memoryless>);

}  // namespace pmesh
