// What a batch of splits is coded against: a mesh, and which of its faces the batch covers so far.
//
// A batch is a set of splits that do not touch: each keeps another vertex, and no face is covered
// by two of them. A split covers the faces of its fan; an ear, which has none, the face that it is
// glued to. All are coded against the mesh as it was before the batch, in the order of its kept
// vertices (see BatchOrder), and then applied, by and large the dearest first.
//
// Threads: the usual; no shared state.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/pm/fan.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

struct BatchSplit {
  VertexSplit split;
  VertexId kept;  ///< Of the split, before the batch.
  int cost = 0;   ///< split_cost(): what the order of application goes by.
};

/// In which order the vertices that a batch's splits keep are coded.
enum class BatchOrder : std::uint8_t {
  ids,            ///< They are named one by one.
  sweep,          ///< A new sweep over all vertices, each of which is marked.
  rest_of_sweep,  ///< What the batches before left of the sweep that was begun last.
};

class BatchMesh {
 public:
  /// The finest LOD of `mesh` must stand whenever a member is called.
  explicit BatchMesh(const RefinableMesh& mesh);

  /// Learns of the vertices and faces that have arrived in `mesh` since.
  void grow(const RefinableMesh& mesh);

  std::uint32_t valence(VertexId v) const { return counts_[v.value].faces; }
  std::uint32_t free_faces(VertexId v) const {
    return counts_[v.value].faces - counts_[v.value].covered;
  }
  /// Asks for what there is of a vertex to be brought into the caches.
  void prefetch(VertexId v) const { __builtin_prefetch(&counts_[v.value]); }
  bool is_free(FaceId f) const { return covered_[f.value] == 0; }
  const std::vector<std::uint8_t>& covered() const { return covered_; }

  /// The order for a batch of `splits` splits that does not go on with a sweep. Naming vertices
  /// takes less than marks at all if few are split.
  BatchOrder order_of(std::size_t splits) const {
    return 32 * std::uint64_t{splits} >= counts_.size() && may_sweep() ? BatchOrder::sweep
                                                                       : BatchOrder::ids;
  }
  /// Whether enough vertices have come since the last sweep began that another one may: so each
  /// pays for the visits to a bounded number of others.
  bool may_sweep() const {
    return 64 * std::uint64_t{counts_.size() - swept_at_} >= counts_.size();
  }
  /// All vertices, family by family, in each by id. A family is a vertex that came with a base or
  /// as a new component and all that were split from it. Neighbours are often of one family: a walk
  /// in this order finds in the caches what ids in order would scatter over the whole mesh. If
  /// there are new ones, nothing is left of the last sweep.
  std::span<const VertexId> vertices_to_sweep();
  /// Begins a sweep over vertices_to_sweep(). Precondition: may_sweep().
  void begin_sweep();
  /// What is left of the sweep that was begun last: batches may share one.
  std::span<const VertexId> rest_of_sweep() const { return std::span(sweep_).subspan(swept_); }
  /// Takes the first `count` off rest_of_sweep().
  void take_off(std::size_t count) {
    assert(count <= rest_of_sweep().size());
    swept_ += count;
  }

  /// Whether all faces that the split of a fan covers are free.
  bool is_free(const Fan& fan) const {
    return std::ranges::all_of(fan.half_edges(),
                               [this](HalfEdgeId h) { return is_free(HalfEdgeMesh::face(h)); });
  }
  /// Covers them. Precondition: they are free.
  void cover(const RefinableMesh& mesh, const Fan& fan);

  /// Applies a batch to `mesh`, window by window of 4,096 splits, in each by falling cost / 2,
  /// those of equal value in their order, and uncovers all faces. Fails if a split is not possible.
  Status apply(std::span<const BatchSplit> batch, RefinableMesh& mesh);
  /// The order in which apply() took the last batch.
  std::span<const std::uint32_t> order() const { return order_; }

  void uncover(const RefinableMesh& mesh);

 private:
  void sort(std::span<const BatchSplit> batch);
  void prefetch(std::span<const BatchSplit> batch, std::size_t place,
                const HalfEdgeMesh& mesh) const;
  void count_faces_of_last(const RefinableMesh& mesh);

  struct FaceCounts {
    std::uint32_t faces = 0, covered = 0;
  };

  std::vector<FaceCounts> counts_;     // by vertex
  std::vector<std::uint8_t> covered_;  // by face
  std::vector<FaceId> covered_faces_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> families_;  // by vertex, numbered as their first vertices come
  std::uint32_t family_count_ = 0;
  std::vector<VertexId> sweep_;
  std::size_t swept_ = 0, swept_at_ = 0;  // of it; vertices when it began
  std::vector<std::uint32_t> family_starts_;
};

}  // namespace pmesh
