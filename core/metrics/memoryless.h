// Memoryless simplification: P. Lindstrom and G. Turk, "Fast and memory efficient polygonal
// simplification", IEEE Visualization 1998. The cost of a collapse is the sum of the squared
// volumes that it sweeps, each tetrahedron between a face before it and the merged vertex, and
// along borders of the squared areas; no vertex carries any history.
#pragma once

#include <string_view>

#include "core/decimate/edge_metric.h"
#include "core/metrics/quadric.h"

namespace pmesh {

/// The merged vertex is placed by volume and border preservation, then by the least cost, then by
/// the shape of its faces.
class Memoryless {
 public:
  static constexpr std::string_view kName = "memoryless";

  /// What the faces of a vertex sum up to, in positions relative to it, where all their planes pass
  /// through the origin. n is twice a face's area vector.
  struct Summary {
    Symmetric areas;   ///< Of n n^T.
    Vec3d normal;      ///< Of n.
    Vec3d neighbours;  ///< Of the neighbours' positions.
    double neighbour_count = 0;
    bool border = false;
    Vec3d previous, next;  ///< Border vertex: its neighbours along the border.
  };

  void start(const HalfEdgeMesh&, std::span<const Vec3d>, const MetricFrame&) {}
  Summary summarise(const PlacedRing& ring) const;
  void place(std::span<const SummedEdge<Summary>> edges, std::span<Placement> placements) const;
  void fold(const EdgeStar&, VertexId /*removed*/, VertexId /*kept*/, Vec3d /*position*/) {}
};

static_assert(EdgeMetric<Memoryless>);

}  // namespace pmesh
