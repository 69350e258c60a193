// Memoryless simplification: P. Lindstrom and G. Turk, "Fast and memory efficient polygonal
// simplification", IEEE Visualization 1998. The cost of a collapse is the sum of the squared
// volumes that it sweeps, each tetrahedron between a face before it and the merged vertex, and
// along borders of the squared areas; no vertex carries any history.
#pragma once

#include <string_view>

#include "core/decimate/edge_star.h"
#include "core/metrics/quadric.h"

namespace pmesh {

/// The merged vertex is placed by volume and border preservation, then by the least cost, then by
/// the shape of its faces.
class Memoryless {
 public:
  static constexpr std::string_view kName = "memoryless";
  static constexpr EdgeReach kReach = EdgeReach::ring;

  /// Sums over the faces and border edges of a vertex, in the unit frame.
  struct Summary {
    Quadric volumes;      ///< f_V: squared volumes of the tetrahedra of a place and the faces.
    Vec3d normal;         ///< Of the faces' doubled areas.
    double distance = 0;  ///< Volume preservation: normal . place = distance.
    Vec3d neighbours;     ///< Positions.
    double neighbour_count = 0;
    bool border = false;
    Quadric border_areas;  ///< f_B: squared areas of the triangles of a place and the border edges.
    Vec3d border_e1, border_e2;

    void add_face(Vec3d a, Vec3d b, Vec3d c, double sign);
    void add_border(Vec3d from, Vec3d to, double sign);
    void add(const Summary& other);
    Summary relative_to(Vec3d origin) const;
  };

  void start(const HalfEdgeMesh&, std::span<const Vec3d>, const MetricFrame&) {}
  Summary summarise(const PlacedRing& ring) const;
  Placement place(const EdgeStar& star, const Summary& a, const Summary& b) const;
  void fold(const EdgeStar&, VertexId /*removed*/, VertexId /*kept*/, Vec3d /*position*/) {}
};

static_assert(EdgeMetric<Memoryless>);

}  // namespace pmesh
