// A progressive mesh in memory: a base, the steps of refinement decoded so far, and the one level
// of detail (LOD) that stands at the moment. Moves to any other LOD exactly, both ways. A step is a
// vertex split or the arrival of new components.
//
// The LOD after k steps uses exactly the ids 0..vertices-1 and 0..faces-1 and is a pure function
// of file and k, whether it was reached by refining or by coarsening. Every step adds vertices and
// faces.
//
// Memory: about 36 bytes a face, 42 if splits relocate; 28 more a face that arrived. Threads: const
// members may be called at the same time; the rest need the mesh to themselves.
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

  /// Adds the arrival of `components` as the next finer step and takes it: their vertices and faces
  /// get the next ids, in their order. Fails, changing nothing, as from_base(), or if they have no
  /// face. Precondition: the finest LOD stands.
  Status append(const LatticeMesh& components);

  /// Takes memory for a full mesh of this size at once. Precondition: vertices >= known_vertices().
  void reserve(std::uint32_t vertices, std::uint32_t faces);

  /// Forgets the steps that the LOD that stands does not use.
  void forget_finer();

  /// Steps known, and steps taken in the LOD that stands.
  std::uint32_t known_steps() const { return static_cast<std::uint32_t>(sites_.size()); }
  std::uint32_t applied_steps() const { return applied_; }
  bool is_finest() const { return applied_steps() == known_steps(); }
  /// Vertices of the finest LOD.
  std::uint32_t known_vertices() const { return static_cast<std::uint32_t>(positions_.size()); }

  /// Whether the last step that the LOD that stands uses is an arrival. Precondition:
  /// applied_steps() > 0.
  bool last_is_arrival() const { return is_arrival(applied_ - 1); }
  /// Of that step, if it is a split: where it was, and how it moved its kept vertex.
  const SplitSite& last_site() const { return sites_[applied_ - 1]; }
  Vec3i last_relocation() const {
    return relocations_.empty() ? Vec3i{} : relocations_[applied_ - 1];
  }

  /// Moves to the LOD of `count` steps. Precondition: count <= known_steps().
  void set_steps(std::uint32_t count);
  void set_finest() { set_steps(known_steps()); }
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
  /// Asks for a vertex's position to be brought into the caches.
  void prefetch(VertexId v) const { __builtin_prefetch(&positions_[v.value]); }

  /// A copy of the LOD that stands.
  LatticeMesh snapshot() const;

 private:
  RefinableMesh() = default;
  bool is_arrival(std::uint32_t step) const { return !sites_[step].half_edge.valid(); }
  std::uint32_t added_vertices() const;  // by the next step
  std::uint32_t added_faces() const;
  void refine_once();
  void coarsen_once();
  void append_step(const SplitSite& site, Vec3i relocation);

  HalfEdgeMesh connectivity_;
  std::vector<Vec3i> positions_;    // of every known vertex: the finer ones stay while coarse
  std::vector<SplitSite> sites_;    // by step; an arrival's half-edge is invalid
  std::vector<Vec3i> relocations_;  // by step; empty as long as none relocates
  std::vector<HalfEdgeMesh> arrivals_;
  std::uint32_t applied_ = 0;
  std::uint32_t arrived_ = 0;  // arrivals among the steps applied
};

}  // namespace pmesh
