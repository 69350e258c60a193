// Blended quadrics: the cost of a half-edge collapse is the sum over the faces around the removed
// vertex, as they are at that moment, of area times the squared distance that the vertex moves off
// the face's plane; along borders, of the squared areas of the triangles that the border sweeps;
// and a share of what QEM would say of the removed vertex, whose quadric remembers its input's
// planes.
//
// Not published in this form. Planes, area weights and memory are QEM's (Garland and Heckbert
// 1997), faces as they are and the border term memoryless simplification's (Lindstrom and Turk
// 1998); H. Hoppe found that quadrics gain by forgetting (New quadric metric for simplifying meshes
// with appearance attributes, IEEE Visualization 1999). Without any memory thin features erode step
// by step at no cost. The default: docs/decisions/0008-default-metric.md has the comparison.
#pragma once

#include <string_view>

#include "core/decimate/metric.h"
#include "core/decimate/ring_lanes.h"
#include "core/metrics/qem.h"
#include "core/metrics/quadric.h"

namespace pmesh {

class BlendedQem {
 public:
  static constexpr std::string_view kName = "blended-qem";
  static constexpr RingGeometry kGeometry = RingGeometry::faces;
  static constexpr bool kInheritsKeys = false;
  static constexpr double kDefaultMemory = 0.3;

  /// `memory`, at least 0, weighs the vertex's own quadric beside its faces' planes.
  explicit BlendedQem(double memory = kDefaultMemory) : memory_(memory) {}

  double memory() const { return memory_; }

  void start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame,
             unsigned threads = 1) {
    remembered_.start(mesh, positions, frame, threads);
  }

  struct Prepared {
    Quadric cost;  ///< Of positions relative to the centre.
  };
  Prepared prepare(const OneRing& ring) const;

  double cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
              const MovedFaces& moved) const;
  /// The costs of all heads of all lanes, to the bit what cost() says.
  void price(const RingLanes& rings, LaneCosts& costs) const;

  double priority(const Prepared& /*prepared*/, double cost, double /*popped*/) const {
    return cost;
  }
  void prefetch(VertexId v) const { remembered_.prefetch(v); }
  void fold(VertexId removed, VertexId kept) { remembered_.fold(removed, kept); }
  void renumber(const CompactIds& ids) { remembered_.renumber(ids); }

 private:
  double memory_;
  QuadricField remembered_;
};

static_assert(HalfEdgeMetric<BlendedQem>);

}  // namespace pmesh
