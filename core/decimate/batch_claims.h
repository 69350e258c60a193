// Which vertices a batch of half-edge collapses keeps, and whether collapses that are legal one by
// one are so together. Private to core/decimate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/metric.h"
#include "core/decimate/one_ring.h"

namespace pmesh {

/// A collapse that claims the vertex that it keeps has it for itself until the batch ends, or it is
/// released. Refers to a mesh, which must outlive it.
class BatchClaims {
 public:
  explicit BatchClaims(const HalfEdgeMesh& mesh) : mesh_(mesh) {}

  void start_batch() { claimants_.assign(mesh_.vertex_slots(), VertexId()); }

  /// False if another one has claimed `kept`.
  bool claim(VertexId removed, VertexId kept) {
    if (claimants_[kept.value].valid()) return false;
    claimants_[kept.value] = removed;
    return true;
  }
  void release(VertexId kept) { claimants_[kept.value] = VertexId(); }

  /// Whether the collapse of the ring's centre into `kept`, which it has claimed, stays legal if
  /// the claimants of lesser ids are collapsed, too. All are legal now, and none are neighbours.
  bool stays_legal(const OneRing& ring, VertexId kept) const {
    for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
      const VertexId other = claimants_[ring.ids[i].value];
      if (!other.valid() || !(other < ring.centre) || !mesh_.is_live(other)) continue;
      if (disturbs(other, i, ring, kept)) return false;
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kFewNeighbours = 3;

  // Whether the collapse of A into K, `kept`, may be illegal once B, `other`, is collapsed into L,
  // A's neighbour number `l`. If K is a neighbour of B, both collapses make the edge KL; if there
  // is one already, between two faces with A and B, there may be too few faces left.
  bool disturbs(VertexId other, std::uint32_t l, const OneRing& ring, VertexId kept) const {
    const auto is_apart = [&](VertexId v) { return v != kept; };
    if (all_neighbours(mesh_, other, is_apart)) return false;
    const std::uint32_t k = ring.index_of(kept), apart = k > l ? k - l : l - k;
    const bool are_joined = apart == 1 || (!ring.border && apart + 1 == ring.neighbours);
    return !are_joined || ring.neighbours <= kFewNeighbours || has_few_neighbours(other);
  }

  bool has_few_neighbours(VertexId v) const {
    std::uint32_t count = 0;
    return all_neighbours(mesh_, v, [&](VertexId) { return ++count <= kFewNeighbours; });
  }

  const HalfEdgeMesh& mesh_;
  std::vector<VertexId> claimants_;  // by vertex: whose collapse keeps it
};

}  // namespace pmesh
