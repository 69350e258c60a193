// QEM: M. Garland and P. S. Heckbert, "Surface simplification using quadric error metrics",
// SIGGRAPH 1997. A vertex carries the sum of the quadrics of its input faces' planes, weighted by
// area, and of planes upright on its border edges; a collapse costs what the two ends' quadrics sum
// up to at the kept vertex's place, which is the head (subset) or the least of the sum (solved).
#pragma once

#include <string_view>
#include <vector>

#include "core/decimate/edge_metric.h"
#include "core/decimate/metric.h"
#include "core/metrics/quadric.h"

namespace pmesh {

/// By vertex, the quadric of its planes in the unit frame (sections 5 and 6 of the paper).
class QuadricField {
 public:
  void start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame,
             unsigned threads = 1);
  const Quadric& operator[](VertexId v) const { return quadrics_[v.value]; }
  /// A quadric is longer than a cache line.
  void prefetch(VertexId v) const {
    __builtin_prefetch(&quadrics_[v.value]);
    __builtin_prefetch(&quadrics_[v.value].c);
  }
  void fold(VertexId removed, VertexId kept) { quadrics_[kept.value] += quadrics_[removed.value]; }
  void renumber(const CompactIds& ids) { close_up(quadrics_, ids.vertices); }

 private:
  // To the quadrics of `vertices` vertices.
  void add_planes(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions,
                  const MetricFrame& frame, std::uint32_t first_vertex, std::uint32_t vertices);

  std::vector<Quadric> quadrics_;
};

/// Positions of every LOD are a subset of the input's.
class QemSubset {
 public:
  static constexpr std::string_view kName = "qem";
  static constexpr RingGeometry kGeometry = RingGeometry::neighbours;
  static constexpr bool kInheritsKeys = false;

  void start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame,
             unsigned threads = 1) {
    quadrics_.start(mesh, positions, frame, threads);
  }

  struct Prepared {
    Quadric centre;  ///< The centre's, relative to it.
  };
  Prepared prepare(const OneRing& ring) const {
    return {quadrics_[ring.centre].relative_to(ring.origin)};
  }

  void prefetch(VertexId v) const { quadrics_.prefetch(v); }

  /// Equation of section 4: (Q1 + Q2)(head).
  double cost(const OneRing& ring, const Prepared& prepared, std::uint32_t head,
              const MovedFaces& moved) const;

  /// What it costs at least: the head's own quadric, which is elsewhere in memory, left out.
  double floor(const OneRing& ring, const Prepared& prepared, std::uint32_t head) const;

  double priority(const Prepared& /*prepared*/, double cost, double /*popped*/) const {
    return cost;
  }
  void fold(VertexId removed, VertexId kept) { quadrics_.fold(removed, kept); }
  void renumber(const CompactIds& ids) { quadrics_.renumber(ids); }

 private:
  QuadricField quadrics_;
};

/// The merged vertex lies where the edge's quadric is least (equation 1).
class QemSolved {
 public:
  static constexpr std::string_view kName = "qem";
  static constexpr bool kNeedsStar = false;

  void start(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame) {
    quadrics_.start(mesh, positions, frame);
  }
  Placement place(const EdgeStar& star) const;
  void fold(const EdgeStar& /*star*/, VertexId removed, VertexId kept, Vec3d /*position*/) {
    quadrics_.fold(removed, kept);
  }

 private:
  QuadricField quadrics_;
};

static_assert(HalfEdgeMetric<QemSubset>);
static_assert(EdgeMetric<QemSolved>);

}  // namespace pmesh
