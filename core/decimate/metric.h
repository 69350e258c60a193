// The seam between the decimation engine and the published metrics: concepts inside the engine, so
// that no candidate costs an indirect call, and one table outside (core/metrics/table.h). This file
// has the metrics that collapse half-edges and leave every vertex where it is; core/decimate/
// edge_metric.h those that collapse edges and place the merged vertex, core/decimate/
// triangle_metric.h those that collapse triangles.
//
// The engine gathers the geometry of every candidate once. A metric reads it and answers; it never
// touches the heap, the mesh or the codec.
//
// Lengths are in units of the mesh's bounding-box diagonal, positions relative to the one-ring's
// centre: a metric's result depends neither on the mesh's unit nor on where the mesh lies.
#pragma once

#include <array>
#include <cassert>
#include <concepts>
#include <cstdint>
#include <limits>
#include <span>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/decimate/metric_frame.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// A face whose doubled area is at most this times its squared longest edge (within a factor of
/// four) has no usable normal: it counts as a face without area.
inline constexpr double kZeroAreaRatio = 1e-10;

/// A vertex, its neighbours and the faces between them, as a structure of arrays.
///
/// Neighbours are in ccw order; face i is (centre, neighbour i, neighbour i+1). Around an interior
/// centre there are as many faces as neighbours, and the arrays of geometry repeat with that
/// period, so that any run of less than a turn is contiguous. Around a border centre there is one
/// face less, and the first and the last neighbour are its neighbours on the border.
struct OneRing {
  /// A vertex with more faces is no origin of a collapse until it has lost some.
  static constexpr std::uint32_t kMaxFaces = kMaxMovedFaces + 1;
  /// Two periods and some slack for vector loops; not near a multiple of 4 KiB, where the arrays
  /// would compete for the same cache lines.
  static constexpr std::uint32_t kCapacity = 2 * kMaxFaces + 40;
  using Row = std::array<double, kCapacity>;

  VertexId centre;
  Vec3d origin;  ///< The centre's position in the unit frame.
  std::uint32_t neighbours = 0;
  std::uint32_t faces = 0;
  bool border = false;  ///< The centre lies on a border.
  /// Invalid from `neighbours` to the end of a block of kIdBlock.
  static constexpr std::uint32_t kIdBlock = 8;
  std::array<VertexId, kMaxFaces + 1 + kIdBlock> ids{};

  Row x{}, y{}, z{};                ///< Neighbours' positions.
  Row nx{}, ny{}, nz{};             ///< Faces' unit normals; zero for a face without area.
  Row area{};                       ///< Faces' areas.
  Vec3d beyond_first, beyond_last;  ///< Border centre: where the border goes on beyond the first
                                    ///< and the last neighbour.

  Vec3d position(std::uint32_t neighbour) const {
    return {x[neighbour], y[neighbour], z[neighbour]};
  }

  bool has_area(std::uint32_t face) const {
    return nx[face] != 0 || ny[face] != 0 || nz[face] != 0;
  }

  /// Which neighbour `v` is. Precondition: it is one.
  std::uint32_t index_of(VertexId v) const {
    std::uint32_t i = 0;
    while (ids[i] != v) ++i;
    assert(i < neighbours);
    return i;
  }
};

/// The faces of a one-ring that survive a collapse of its centre, as they are after it. Moved face
/// k was face first + k of the ring.
struct MovedFaces {
  static constexpr std::uint32_t kCapacity = OneRing::kMaxFaces + 40;
  using Row = std::array<double, kCapacity>;

  std::uint32_t first = 0;
  std::uint32_t count = 0;
  Row nx{}, ny{}, nz{};  ///< Unit normals; zero for a face without area.
  Row area{};
  Row cosine{};  ///< Of the angle between the normals before and after; 0 if one has none.

  bool has_area(std::uint32_t face) const {
    return nx[face] != 0 || ny[face] != 0 || nz[face] != 0;
  }
};

/// What a metric needs to know of a candidate half-edge collapse.
enum class RingGeometry : std::uint8_t {
  neighbours,   ///< The ring without its faces.
  faces,        ///< The whole ring.
  moved_faces,  ///< The ring, and its faces as they are after the collapse.
};

/// A cost that refuses the candidate.
inline constexpr double kRefused = std::numeric_limits<double>::infinity();

/// A metric that collapses half-edges; positions of every LOD are a subset of the input's.
/// Copyable; const members are called from several threads at the same time.
template <class M>
concept HalfEdgeMetric = requires(M metric, const M& const_metric, const HalfEdgeMesh& mesh,
                                  std::span<const Vec3d> positions, const MetricFrame& frame,
                                  const OneRing& ring, const MovedFaces& moved, std::uint32_t head,
                                  double cost, double popped, VertexId v, unsigned threads,
                                  const CompactIds& ids) {
  { M::kGeometry } -> std::convertible_to<RingGeometry>;
  /// Whether priority() looks at `popped`.
  { M::kInheritsKeys } -> std::convertible_to<bool>;
  /// Makes the per-vertex state of a mesh, before anything else is asked.
  { metric.start(mesh, positions, frame, threads) } -> std::same_as<void>;
  /// Asks for the state of a vertex to be brought into the processor's caches.
  { const_metric.prefetch(v) } -> std::same_as<void>;
  /// What all candidates of the ring's centre have in common.
  { const_metric.prepare(ring) } -> std::same_as<typename M::Prepared>;
  /// The cost, at least 0, of collapsing the ring's centre into its neighbour `head`. The
  /// engine has checked the border rules, and refuses fold-overs and broken links itself.
  /// `moved` is there for RingGeometry::moved_faces only.
  { const_metric.cost(ring, const_metric.prepare(ring), head, moved) } -> std::same_as<double>;
  /// The key in the queue of a centre whose best candidate costs `cost`; the least is popped
  /// first. `popped` is the key of the collapse that made this evaluation necessary, 0 at
  /// first.
  { const_metric.priority(const_metric.prepare(ring), cost, popped) } -> std::same_as<double>;
  /// Folds the per-vertex state of the removed into the kept vertex, once the mesh has changed.
  { metric.fold(v, v) } -> std::same_as<void>;
  /// Follows the mesh to compact ids.
  { metric.renumber(ids) } -> std::same_as<void>;
};

}  // namespace pmesh
