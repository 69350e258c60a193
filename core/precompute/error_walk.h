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

/// Threads: one at a time.
class ErrorWalk {
 public:
  /// Begins at the finest LOD of `mesh`, whose vertices are those of `original` on its lattice.
  /// `mesh` must outlive the object and be moved by it alone.
  ErrorWalk(RefinableMesh& mesh, const Lattice& lattice, const IndexedMesh& original,
            const UnitFrame& frame);

  /// Precondition: `splits` is not above mesh.applied_splits().
  void coarsen_to(std::uint32_t splits);

  /// Of the LOD that stands; bounds may be made tighter.
  FaceErrors& errors() { return errors_; }

 private:
  void coarsen_once();
  void gather(VertexId removed, VertexId kept);
  bool gather_star(VertexId center, VertexId first);
  void gather_around();
  double gap_of(VertexId removed, VertexId kept);
  std::optional<double> plain_gap(VertexId removed, VertexId kept);
  double odd_gap(VertexId removed, VertexId kept, double limit);
  void exchange(double gap);
  Vec3d unit(Vec3i point) const { return frame_.to_unit(positions_(point)); }
  Vec3d position(VertexId v) const { return unit(mesh_.positions()[v.value]); }
  Corners corners(std::uint32_t face) const;

  RefinableMesh& mesh_;
  ExportedPositions positions_;
  UnitFrame frame_;
  FaceErrors errors_;
  CollapseGap gap_;

  // Of the collapse that is undone to coarsen: the faces that it changes, and the link.
  std::vector<std::uint32_t> star_;
  std::vector<VertexId> link_, removed_link_;
  std::vector<Vec3d> link_positions_;
  bool on_border_ = false;
  Vec3d merged_;
  std::vector<std::uint32_t> around_;  // the faces beyond the link, in odd cases
};

}  // namespace pmesh
