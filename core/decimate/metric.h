// The seam between the decimation engine and the published metrics: a concept inside the engine,
// so that no candidate costs an indirect call, and one table outside (core/metrics/table.h).
//
// The engine gathers the geometry of every candidate once. A metric reads it and answers; it never
// touches the heap, the mesh or the codec.
//
// Lengths are in units of the mesh's bounding-box diagonal, positions relative to the one-ring's
// centre: a metric's result depends neither on the mesh's unit nor on where the mesh lies.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

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
  std::uint32_t neighbours = 0;
  std::uint32_t faces = 0;
  bool border = false;  ///< The centre lies on a border.
  std::array<VertexId, kMaxFaces + 1> ids{};

  Row x{}, y{}, z{};                ///< Neighbours' positions.
  Row nx{}, ny{}, nz{};             ///< Faces' unit normals; zero for a face without area.
  Row area{};                       ///< Faces' areas.
  Vec3d beyond_first, beyond_last;  ///< Border centre: where the border goes on beyond the first
                                    ///< and the last neighbour.

  Vec3d position(std::uint32_t neighbour) const {
    return {x[neighbour], y[neighbour], z[neighbour]};
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
};

/// Where a metric may put the kept vertex.
enum class Placement : std::uint8_t {
  subset,  ///< It stays where it is: the positions of every LOD are a subset of the input's.
};

/// What a metric says about a candidate.
struct Proposal {
  double cost = std::numeric_limits<double>::infinity();  ///< Infinite: refused.
};

/// A published metric. Copyable; const members are called from several threads at the same time.
template <class M>
concept Metric = requires(M metric, const M& const_metric, const OneRing& ring,
                          const MovedFaces& moved, std::uint32_t head, double cost, double popped,
                          VertexId v) {
  { M::kPlacement } -> std::convertible_to<Placement>;
  /// The cost of collapsing the ring's centre into its neighbour `head`. The engine has checked
  /// the border rules, and refuses fold-overs and broken links itself.
  { const_metric.propose(ring, head, moved) } -> std::same_as<Proposal>;
  /// The key in the queue of a centre whose best candidate costs `cost`; the least is popped
  /// first. `popped` is the key of the collapse that made this evaluation necessary, 0 at first.
  { const_metric.priority(ring, cost, popped) } -> std::same_as<double>;
  /// Folds the per-vertex state of the removed into the kept vertex, once the mesh has changed.
  { metric.fold(v, v) } -> std::same_as<void>;
};

}  // namespace pmesh
