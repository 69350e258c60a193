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
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// An edge and the faces and border edges around its two ends.
struct EdgeStar {
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
  Vec3d position_a, position_b;
  bool a_on_border = false, b_on_border = false;
  bool on_border = false;  ///< The edge itself.
  Vec3d left;              ///< The apex of the face to the left of a -> b.
  Vec3d right;             ///< That of the other face, if not on_border.

  // What follows is filled by gather_star() only.
  std::vector<Face> faces;          ///< Those that survive, of a and of b.
  std::vector<BorderEdge> borders;  ///< With an end in a or b; the edge itself, too.
};

/// A vertex and its neighbours, in the unit frame.
struct PlacedRing {
  Vec3d centre;
  std::array<Vec3d, OneRing::kMaxFaces + 1> neighbours;  ///< Ccw; on a border from end to end.
  std::uint32_t count = 0;  ///< Of neighbours. Face i is (centre, neighbour i, neighbour i + 1).
  std::uint32_t faces = 0;  ///< As many, or on a border one less.
  bool border = false;

  Vec3d after(std::uint32_t i) const { return neighbours[i + 1 < count ? i + 1 : 0]; }
};

/// What a metric says about an edge.
struct Placement {
  double cost = kRefused;  ///< At least 0; kRefused refuses the edge.
  Vec3d position;          ///< Of the merged vertex, relative to the midpoint.
};

/// Which edges have another cost after a collapse.
enum class EdgeReach : std::uint8_t {
  merged,  ///< Those of the merged vertex.
  ring,    ///< Those of the merged vertex and of its neighbours.
};

/// What every metric that collapses edges has. Copyable; const members are called from several
/// threads at the same time.
template <class M>
concept EdgeMetricState = requires(M metric, const HalfEdgeMesh& mesh,
                                   std::span<const Vec3d> positions, const MetricFrame& frame,
                                   const EdgeStar& star, VertexId v) {
  { M::kReach } -> std::convertible_to<EdgeReach>;
  /// Makes the per-vertex state of a mesh, before anything else is asked.
  { metric.start(mesh, positions, frame) } -> std::same_as<void>;
  /// Folds the per-vertex state of the removed into the kept vertex, before the mesh is changed.
  { metric.fold(star, v, v, Vec3d{}) } -> std::same_as<void>;
};

/// A metric that looks at an edge's ends and, if it says so, at its star.
template <class M>
concept StarMetric = EdgeMetricState<M> && requires(const M& metric, const EdgeStar& star) {
  /// Whether place() reads what gather_star() fills.
  { M::kNeedsStar } -> std::convertible_to<bool>;
  /// The cost of the edge and where it puts the merged vertex. The engine refuses fold-overs and
  /// broken links itself.
  { metric.place(star) } -> std::same_as<Placement>;
};

/// A metric for which sums over the one-rings of both ends say enough of the star: the engine has
/// them made once for all edges of a vertex.
template <class M>
concept SummaryMetric = EdgeMetricState<M> &&
    requires(const M& metric, const EdgeStar& star, const PlacedRing& ring,
             const typename M::Summary& summary) {
  { metric.summarise(ring) } -> std::same_as<typename M::Summary>;
  /// As above, with the summaries of a and b; reads nothing that gather_star() fills.
  { metric.place(star, summary, summary) } -> std::same_as<Placement>;
};

template <class M>
concept EdgeMetric = StarMetric<M> || SummaryMetric<M>;

/// Fills in `star`, but for what gather_star() adds, for the edge of `half_edge`.
void gather_ends(const WorkingMesh& work, HalfEdgeId half_edge, EdgeStar& star);

/// Fills in the rest. False if an end has more than EdgeStar::kMaxFaces faces; the walk stops
/// there.
bool gather_star(const WorkingMesh& work, EdgeStar& star);

/// False if `v` has more than OneRing::kMaxFaces faces; the walk stops there.
bool gather_ring(const WorkingMesh& work, VertexId v, PlacedRing& ring);

/// Whether a surviving face of `star` turns by more than 90 degrees or loses its area, once its end
/// is at `position`. Faces without area to begin with do not count.
bool folds_over(const EdgeStar& star, Vec3d position);

}  // namespace pmesh
