// A progressive mesh in memory: a base, the vertex splits decoded so far, and the one level of
// detail (LOD) that stands at the moment. Moves to any other LOD exactly, both ways.
//
// The LOD after k splits uses exactly the ids 0..vertices-1 and 0..faces-1 and is a pure function
// of file and k, whether it was reached by refining or by coarsening.
//
// Memory: about 36 bytes a face, 42 if splits relocate. Threads: const members may be called at the
// same time; the rest need the mesh to themselves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/mesh/half_edge_mesh.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// One vertex split: where, the new vertex's position on the lattice, and by how much the kept
/// vertex moves (undone exactly when the split is; zero where metrics leave it in place). All
/// positions lie in [0, 2^kMaxLatticeBits).
struct VertexSplit {
  SplitSite site;
  Vec3i position;
  Vec3i relocation = {};
};

/// The vertex that a split at `site` of `mesh` keeps.
inline VertexId kept_vertex(const HalfEdgeMesh& mesh, const SplitSite& site) {
  return site.kind == SplitKind::border_last ? mesh.target(site.half_edge)
                                             : mesh.origin(site.half_edge);
}

class RefinableMesh {
 public:
  /// Fails (bad_input) if `base` is not an oriented 2-manifold without unused vertices.
  static Result<RefinableMesh> from_base(const LatticeMesh& base);

  /// Adds the next finer split and applies it. Fails (bad_input), changing nothing, if the split
  /// is not possible. Precondition: the finest LOD stands.
  Status append(const VertexSplit& split);

  /// Takes memory for a full mesh of this size at once. Precondition: vertices >= vertex_count().
  void reserve(std::uint32_t vertices, std::uint32_t faces);

  /// Forgets the splits that the LOD that stands does not use.
  void forget_finer();

  /// Splits known, and splits applied in the LOD that stands.
  std::uint32_t known_splits() const { return static_cast<std::uint32_t>(sites_.size()); }
  std::uint32_t applied_splits() const { return applied_; }
  bool is_finest() const { return applied_splits() == known_splits(); }

  /// Of the last split that the LOD that stands uses: where it was, and how it moved its kept
  /// vertex. Precondition: applied_splits() > 0.
  const SplitSite& last_site() const { return sites_[applied_ - 1]; }
  Vec3i last_relocation() const {
    return relocations_.empty() ? Vec3i{} : relocations_[applied_ - 1];
  }

  /// Moves to the LOD of `count` splits. Precondition: count <= known_splits().
  void set_splits(std::uint32_t count);
  void set_finest() { set_splits(known_splits()); }
  /// Moves to the largest known LOD with at most `count` faces (vertices); to the base if even
  /// that has more.
  void set_faces(std::uint64_t count);
  void set_vertices(std::uint64_t count);

  std::uint32_t vertex_count() const { return connectivity_.live_vertices(); }
  std::uint32_t face_count() const { return connectivity_.live_faces(); }

  /// Positions of the LOD that stands, by vertex.
  std::span<const Vec3i> positions() const { return {positions_.data(), vertex_count()}; }
  /// Three vertices a face: an index buffer. Valid until the LOD changes.
  std::span<const VertexId> corners() const { return connectivity_.corners(); }
  const HalfEdgeMesh& connectivity() const { return connectivity_; }

  /// A copy of the LOD that stands.
  LatticeMesh snapshot() const;

 private:
  RefinableMesh() = default;
  std::uint32_t base_vertices() const {
    return static_cast<std::uint32_t>(positions_.size()) - known_splits();
  }
  void refine_once();
  void coarsen_once();
  void append_relocation(Vec3i relocation);

  HalfEdgeMesh connectivity_;
  std::vector<Vec3i> positions_;  // of every known vertex: the finer ones stay while coarse
  std::vector<SplitSite> sites_;
  std::vector<Vec3i> relocations_;  // by split; empty as long as none relocates
  std::uint32_t applied_ = 0;
};

}  // namespace pmesh
