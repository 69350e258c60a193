// The one-rings of a few vertices side by side, so that what all of them need is calculated with
// one instruction. For the common case only: inside the mesh, with few neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/decimate/metric.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// Rows of coordinates, an element a lane. Lane l has count[l] neighbours in ccw order, then the
/// first one again, and zeros up to row `rows`. Units and origins are OneRing's.
class RingLanes {
 public:
  static constexpr std::uint32_t kLanes = 4;
  static constexpr std::uint32_t kMaxNeighbours = 15;
  struct alignas(kLanes * sizeof(double)) Row : std::array<double, kLanes> {};
  using Rows = std::array<Row, kMaxNeighbours + 1>;

  std::uint32_t used = 0;  ///< Lanes; the others have no neighbours.
  std::uint32_t rows = 0;  ///< The most neighbours of a lane.
  std::array<VertexId, kLanes> centre{};
  std::array<Vec3d, kLanes> origin{};
  std::array<std::uint32_t, kLanes> count{};
  std::array<std::array<VertexId, kMaxNeighbours>, kLanes> ids;
  Rows x{}, y{}, z{};

  void clear() { used = 0; }
  bool is_full() const { return used == kLanes; }

  /// Puts the ring of live vertex `v` into the next lane; false if it is not of the common kind.
  bool add(const WorkingMesh& work, VertexId v) {
    if (!gather_ids(work.mesh(), v)) return false;
    const Vec3d middle = work.position(v);
    centre[used] = v;
    origin[used] = work.frame().to_unit(middle);
    for (std::uint32_t i = 0; i < count[used]; ++i) {
      put(i, work.frame().scale * (work.position(ids[used][i]) - middle));
    }
    put(count[used], position(used, 0));
    ++used;
    return true;
  }

  /// After the last add(): fills up with zeros.
  void close() {
    for (std::uint32_t lane = used; lane < kLanes; ++lane) count[lane] = 0;
    rows = *std::max_element(count.begin(), count.end());
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t first = lane < used ? count[lane] + 1 : 0;
      for (std::uint32_t i = first; i <= rows; ++i) x[i][lane] = y[i][lane] = z[i][lane] = 0;
    }
  }

  Vec3d position(std::uint32_t lane, std::uint32_t neighbour) const {
    return {x[neighbour][lane], y[neighbour][lane], z[neighbour][lane]};
  }

 private:
  bool gather_ids(const HalfEdgeMesh& mesh, VertexId v) {
    const HalfEdgeId first = mesh.outgoing(v);
    HalfEdgeId h = first;
    std::uint32_t neighbours = 0;
    do {
      if (neighbours == kMaxNeighbours) return false;
      ids[used][neighbours++] = mesh.target(h);
      h = mesh.rotate_ccw(h);
    } while (h.valid() && h != first);
    count[used] = neighbours;
    return h.valid();
  }

  void put(std::uint32_t neighbour, Vec3d p) {
    x[neighbour][used] = p.x;
    y[neighbour][used] = p.y;
    z[neighbour][used] = p.z;
  }
};

/// The costs of heads: row i for neighbour i.
using LaneCosts = RingLanes::Rows;

/// What a lane's costs and positions say, by lane.
struct LaneChoices {
  RingLanes::Row best;        ///< The first of the cheapest heads.
  RingLanes::Row most;        ///< Its cost, and what is negligible beside it.
  RingLanes::Row alike;       ///< How many heads cost at most that.
  RingLanes::Row off_centre;  ///< The squared distance of the centre from its neighbours' middle
                              ///< over their variance; 0 if they have none.
};

/// Costs are `negligible` if they are below so many times the fourth power of the edges' length
/// (the root of the mean of their squares).
LaneChoices choose_heads(const RingLanes& rings, const LaneCosts& costs, double negligible);

}  // namespace pmesh
