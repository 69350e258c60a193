// What a batch of splits is coded against: a mesh, and which of its faces the batch covers so far.
//
// A batch is a set of splits that do not touch: each keeps another vertex, and no face is covered
// by two of them. A split covers the faces of its fan; an ear, which has none, the face that it is
// glued to. All are coded against the mesh as it was before the batch, in the order of its kept
// vertices (see is_sparse()), and then applied dearest first.
//
// Threads: the usual; no shared state.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

struct BatchSplit {
  VertexSplit split;
  VertexId kept;  ///< Of the split, before the batch.
  int cost = 0;   ///< split_cost(): what the order of application goes by.
};

class BatchMesh {
 public:
  /// The finest LOD of `mesh` must stand whenever a member is called.
  explicit BatchMesh(const RefinableMesh& mesh);

  /// Learns of the vertices and faces that have arrived in `mesh` since.
  void grow(const RefinableMesh& mesh);

  std::uint32_t valence(VertexId v) const { return valences_[v.value]; }  ///< In faces.
  std::uint32_t free_faces(VertexId v) const { return valences_[v.value] - covered_at_[v.value]; }
  /// Asks for what there is of a vertex to be brought into the caches.
  void prefetch(VertexId v) const {
    __builtin_prefetch(&valences_[v.value]);
    __builtin_prefetch(&covered_at_[v.value]);
  }
  bool is_free(FaceId f) const { return covered_[f.value] == 0; }
  const std::vector<std::uint8_t>& covered() const { return covered_; }

  /// Whether a batch of that many splits names the kept vertices, in the order of their ids; others
  /// have a mark at every vertex, in the order of the sweep.
  bool is_sparse(std::size_t splits) const { return 32 * std::uint64_t{splits} < valences_.size(); }
  /// All vertices, family by family, in each by id. A family is a vertex that came with a base or
  /// as a new component and all that were split from it. Neighbours are often of one family: a walk
  /// in this order finds in the caches what ids in order would scatter over the whole mesh.
  std::span<const VertexId> sweep();
  /// The part of it after the kept vertex of the last split of the batch applied last.
  /// Precondition: a batch was applied.
  std::span<const VertexId> rest_of_sweep();
  bool has_batch() const { return last_kept_.valid(); }  ///< Whether one was applied.

  /// Covers the faces of a split. Precondition: they are free.
  void cover(const RefinableMesh& mesh, const SplitSite& site);

  /// Applies a batch of at least one split to `mesh`, dearest splits first, those of equal cost in
  /// their order, and uncovers all faces. Fails if a split is not possible.
  Status apply(std::span<const BatchSplit> batch, RefinableMesh& mesh);
  /// The order in which apply() took the last batch.
  std::span<const std::uint32_t> order() const { return order_; }

  void uncover(const RefinableMesh& mesh);

 private:
  void cover(const RefinableMesh& mesh, FaceId f);
  void sort(std::span<const BatchSplit> batch);
  void count_faces_of_last(const RefinableMesh& mesh);

  std::vector<std::uint32_t> valences_, covered_at_;  // by vertex
  std::vector<std::uint8_t> covered_;                 // by face
  std::vector<FaceId> covered_faces_;
  std::vector<std::uint32_t> order_;
  VertexId last_kept_;
  std::vector<std::uint32_t> families_;  // by vertex, numbered as their first vertices come
  std::uint32_t family_count_ = 0;
  std::vector<VertexId> sweep_;  // stale if there are more vertices
  std::vector<std::uint32_t> family_starts_;
};

}  // namespace pmesh
