// Memoryless quadrics: the cost of a half-edge collapse is the sum over the faces around the
// removed vertex, as they are at that moment, of area times the squared distance that the vertex
// moves off the face's plane; along borders, of the squared areas of the triangles that the border
// sweeps.
//
// Not published in this form. The planes and the area weights are QEM's (Garland and Heckbert
// 1997), the want of any history and the border term memoryless simplification's (Lindstrom and
// Turk 1998); H. Hoppe found that quadrics gain by forgetting (New quadric metric for simplifying
// meshes with appearance attributes, IEEE Visualization 1999). The default: see
// docs/decisions/0008-default-metric.md.
#pragma once

#include <string_view>

#include "core/decimate/metric.h"
#include "core/metrics/quadric.h"

namespace pmesh {

class MemorylessQem {
 public:
  static constexpr std::string_view kName = "memoryless-qem";
  static constexpr RingGeometry kGeometry = RingGeometry::faces;

  void start(const HalfEdgeMesh&, std::span<const Vec3d>, const MetricFrame&) {}

  struct Prepared {
    Quadric planes;  ///< Of the centre's faces, and of its border's lines.
  };
  Prepared prepare(const OneRing& ring) const;

  double cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
              const MovedFaces& moved) const;
  double priority(const Prepared& /*prepared*/, double cost, double /*popped*/) const {
    return cost;
  }
  void fold(VertexId /*removed*/, VertexId /*kept*/) {}
};

static_assert(HalfEdgeMetric<MemorylessQem>);

}  // namespace pmesh
