// Bounds on the error of every face of a progressive mesh, from its finest level of detail (LOD)
// to coarser ones: what a collapse exchanges is as far from the original as what was there, and
// farther by no more than the gap between both (core/measure/collapse_gap.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/io/export.h"
#include "core/measure/collapse_gap.h"
#include "core/measure/face_errors.h"
#include "core/measure/surface.h"
#include "core/mesh/indexed_mesh.h"
#include "core/mesh/lattice.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// Coarsening has two halves, so that the first may run while a level is measured.
///
/// Threads: one at a time, but for plan_to(), which may run while errors() is used.
class ErrorWalk {
 public:
  /// Begins at the finest LOD of `mesh`, whose vertices are those of `original` on its lattice.
  /// `mesh` must outlive the object and be moved by it alone.
  ErrorWalk(RefinableMesh& mesh, const Lattice& lattice, const IndexedMesh& original,
            const UnitFrame& frame);

  /// Coarsens the mesh to the LOD of at most that many vertices, or to the base, and takes note of
  /// what each collapse exchanges.
  void plan_to(std::uint64_t vertices);
  /// Brings errors() up to the LOD that stands.
  void follow();

  /// Of the LOD that stood at the last follow(); bounds may be made tighter.
  FaceErrors& errors() { return errors_; }

 private:
  // A collapse, or the leave of components that arrived. Its faces are those in `exchanged_` from
  // one entry's begin to the next one's.
  struct Exchange {
    double gap;
    std::uint32_t faces_after;  // of the mesh
    std::uint32_t star_begin, around_begin;
  };

  void plan_collapse();
  void plan_leave();
  void gather(VertexId removed, VertexId kept);
  bool gather_star(VertexId center, VertexId first);
  void gather_around();
  double gap_of(VertexId removed, VertexId kept);
  std::optional<double> plain_gap(VertexId removed, VertexId kept);
  double odd_gap(VertexId removed, VertexId kept, double limit);
  void exchange(const Exchange& exchange, std::uint32_t end);
  Vec3d unit(Vec3i point) const { return frame_.to_unit(positions_(point)); }
  Vec3d position(VertexId v) const { return unit(mesh_.positions()[v.value]); }
  Corners corners(std::uint32_t face) const;

  RefinableMesh& mesh_;
  ExportedPositions positions_;
  UnitFrame frame_;
  FaceErrors errors_;

  // Planned, not yet followed.
  std::vector<Exchange> exchanges_;
  std::vector<std::uint32_t> exchanged_;

  // Of the collapse that is planned: the faces that it changes, and the link.
  CollapseGap gap_;
  std::vector<std::uint32_t> star_;
  std::vector<VertexId> link_, removed_link_;
  std::vector<Vec3d> link_positions_;
  bool on_border_ = false;
  Vec3d merged_;
  std::vector<std::uint32_t> around_;  // the faces beyond the link, in odd cases
};

}  // namespace pmesh
