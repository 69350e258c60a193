// The seam for metrics that collapse edges and place the merged vertex freely.
//
// Lengths are in units of the mesh's bounding-box diagonal, positions relative to the edge's
// midpoint.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/metric.h"

namespace pmesh {

/// An edge, whose ends are a and b, and the apexes of its faces.
struct PlacedEdge {
  Vec3d position_a, position_b;
  Vec3d left;              ///< The apex of the face to the left of a -> b.
  Vec3d right;             ///< That of the other face, if not on_border.
  bool on_border = false;  ///< The edge itself.
};

/// An edge and the faces and border edges around its two ends.
struct EdgeStar : PlacedEdge {
  /// An end with more faces is not merged until it has lost some.
  static constexpr std::uint32_t kMaxFaces = OneRing::kMaxFaces;

  /// A face that survives the collapse: its corner `end` becomes the merged vertex.
  struct Face {
    Vec3d end, second, third;  ///< Corners, ccw.
    bool of_a = false;         ///< Whether `end` is a (else b).
  };
  struct BorderEdge {
    Vec3d from, to;  ///< The mesh lies to the left.
  };

  HalfEdgeId half_edge;  ///< From a to b. The edge's only half-edge, if it lies on a border.
  VertexId a, b;
  Vec3d origin;  ///< The edge's midpoint in the unit frame.
  bool a_on_border = false, b_on_border = false;

  // What follows is filled by gather_star() only (see edge_star.h).
  std::vector<Face> faces;          ///< Those that survive, of a and of b.
  std::vector<BorderEdge> borders;  ///< With an end in a or b; the edge itself, too.
};

/// A vertex's neighbours, relative to it, as a structure of arrays. Ccw; on a border from end to
/// end, else followed by the first once more. Then zeros, up to a whole block of faces.
struct PlacedRing {
  static constexpr std::uint32_t kBlock = 4;
  using Row = std::array<double, OneRing::kMaxFaces + 2 * kBlock>;

  Row x, y, z;
  std::uint32_t count = 0;  ///< Of neighbours. Face i is (vertex, neighbour i, neighbour i + 1).
  std::uint32_t faces = 0;  ///< As many, or on a border one less.
  bool border = false;

  Vec3d neighbour(std::uint32_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::uint32_t i, Vec3d p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }

  /// Once `positions` are set, around an interior vertex the first once more.
  void finish(std::uint32_t positions, bool on_border) {
    border = on_border;
    faces = positions - 1;
    count = on_border ? positions : faces;
    for (std::uint32_t i = 0; i < kBlock; ++i) set(positions + i, {});
  }
};

/// What a metric says about an edge.
struct Placement {
  double cost = kRefused;  ///< At least 0; kRefused refuses the edge.
  Vec3d position;          ///< Of the merged vertex, relative to the midpoint.
};

/// What every metric that collapses edges has. Copyable; const members are called from several
/// threads at the same time.
template <class M>
concept EdgeMetricState = requires(M metric, const HalfEdgeMesh& mesh,
                                   std::span<const Vec3d> positions, const MetricFrame& frame,
                                   const EdgeStar& star, VertexId v) {
  /// Makes the per-vertex state of a mesh, before anything else is asked.
  { metric.start(mesh, positions, frame) } -> std::same_as<void>;
  /// Folds the per-vertex state of the removed into the kept vertex, before the mesh is changed.
  { metric.fold(star, v, v, Vec3d{}) } -> std::same_as<void>;
};

/// A metric that looks at an edge's ends and, if it says so, at its star. A collapse changes the
/// costs of the merged vertex's edges.
template <class M>
concept StarMetric = EdgeMetricState<M> && requires(const M& metric, const EdgeStar& star) {
  /// Whether place() reads what gather_star() fills.
  { M::kNeedsStar } -> std::convertible_to<bool>;
  /// The cost of the edge and where it puts the merged vertex. The engine refuses fold-overs and
  /// broken links itself.
  { metric.place(star) } -> std::same_as<Placement>;
};

/// An edge with what its ends' one-rings sum up to.
template <class Summary>
struct SummedEdge {
  PlacedEdge edge;
  const Summary* a = nullptr;
  const Summary* b = nullptr;
};

/// A metric for which sums over the one-rings of both ends say enough of the star: the engine has
/// them made once for all edges of a vertex. A collapse changes the costs of the merged vertex's
/// and of its neighbours' edges.
template <class M>
concept SummaryMetric = EdgeMetricState<M> &&
    requires(const M& metric, const PlacedRing& ring,
             std::span<const SummedEdge<typename M::Summary>> edges,
             std::span<Placement> placements) {
  { metric.summarise(ring) } -> std::same_as<typename M::Summary>;
  { edges.front().a->border } -> std::convertible_to<bool>;  ///< The vertex lies on a border.
  /// As above, of as many edges at once. The placement of an edge does not depend on the others.
  { metric.place(edges, placements) } -> std::same_as<void>;
};

template <class M>
concept EdgeMetric = StarMetric<M> || SummaryMetric<M>;

}  // namespace pmesh
