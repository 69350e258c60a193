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

  // What follows is filled by gather_star() only.
  std::vector<Face> faces;          ///< Those that survive, of a and of b.
  std::vector<Vec3d> apexes;        ///< Of the edge's own faces: left, and right if there is one.
  std::vector<BorderEdge> borders;  ///< With an end in a or b; the edge itself, too.

  bool on_border() const { return apexes.size() == 1; }
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

/// A metric that collapses edges. Copyable; const members are called from several threads at the
/// same time.
template <class M>
concept EdgeMetric = requires(M metric, const M& const_metric, const HalfEdgeMesh& mesh,
                              std::span<const Vec3d> positions, const MetricFrame& frame,
                              const EdgeStar& star, VertexId v) {
  { M::kReach } -> std::convertible_to<EdgeReach>;
  /// Whether place() reads what gather_star() fills.
  { M::kNeedsStar } -> std::convertible_to<bool>;
  /// Makes the per-vertex state of a mesh, before anything else is asked.
  { metric.start(mesh, positions, frame) } -> std::same_as<void>;
  /// The cost of the edge and where it puts the merged vertex. The engine refuses fold-overs and
  /// broken links itself.
  { const_metric.place(star) } -> std::same_as<Placement>;
  /// Folds the per-vertex state of the removed into the kept vertex, before the mesh is changed.
  { metric.fold(star, v, v, Vec3d{}) } -> std::same_as<void>;
};

/// Fills in `star`, but for what gather_star() adds, for the edge of `half_edge`.
void gather_ends(const WorkingMesh& work, HalfEdgeId half_edge, EdgeStar& star);

/// Fills in the rest. False if an end has more than EdgeStar::kMaxFaces faces; the walk stops
/// there.
bool gather_star(const WorkingMesh& work, EdgeStar& star);

/// Whether a surviving face of `star` turns by more than 90 degrees or loses its area, once its end
/// is at `position`. Faces without area to begin with do not count.
bool folds_over(const EdgeStar& star, Vec3d position);

}  // namespace pmesh
