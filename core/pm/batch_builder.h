// Takes a collapse log backwards and gathers its splits into batches of splits that do not touch.
// Those of components that have not arrived yet are left out until they do.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/decimate/collapse_log.h"
#include "core/mesh/lattice.h"
#include "core/pm/batch_mesh.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// Splits of a log, last collapse first. All arguments must outlive it.
class BatchBuilder {
 public:
  /// `positions` by original vertex, on `lattice`.
  BatchBuilder(const CollapseLog& log, std::span<const Vec3i> positions, const Lattice& lattice);

  /// Tells it that a vertex stands in `mesh`.
  void place(VertexId original, VertexId file_id) { file_ids_[original.value] = file_id; }
  /// Adds splits to come: those of components whose base vertices are placed, by their places in
  /// the log, ascending.
  void add(std::span<const std::uint32_t> splits);

  std::size_t left() const { return to_come_.size(); }  ///< Splits to come.

  /// The longest run of the next splits that do not touch, in the order in which they are coded,
  /// against `mesh`, which has all splits before. Leaves `state` uncovered. Never empty while there
  /// are splits left. (Applying some of them leaves the others as they are.) If the batch is to be
  /// a sweep, nothing is left of the last one.
  std::vector<BatchSplit> next(const RefinableMesh& mesh, BatchMesh& state);

  /// Tells it that those from `begin` on of next()'s batch were applied, in the order `order`:
  /// their new vertices' ids begin at `first_vertex`.
  void applied(std::size_t begin, std::span<const std::uint32_t> order, std::uint32_t first_vertex);

  /// Splits that next() would return, about, from the log's own batches. Precondition: left() > 0.
  std::size_t batch_size_ahead() const;

 private:
  using Batch = std::vector<std::pair<BatchSplit, std::uint32_t>>;  // and its place in the log

  void sort(Batch& batch, BatchMesh& state);
  std::optional<BatchSplit> split_at(std::size_t index, const RefinableMesh& mesh) const;
  VertexId file_id(VertexId original) const {
    return original.valid() ? file_ids_[original.value] : original;
  }

  const CollapseLog& log_;
  std::span<const Vec3i> positions_;
  const Lattice& lattice_;
  std::vector<VertexId> file_ids_;
  std::vector<std::uint32_t> to_come_;  // places in the log, ascending: the last is next
  std::vector<std::uint32_t> batch_;    // places in the log, in the batch's order
  std::vector<std::uint32_t> kept_in_;  // by file id: the batch that last kept it
  std::uint32_t batch_number_ = 0;
  std::vector<std::uint32_t> place_;  // by file id, in the sweep
};

/// The site in `mesh` whose split undoes `collapse`, whose vertices stand in `mesh`; nothing if
/// they do not bound a fan there.
std::optional<SplitSite> find_site(const HalfEdgeMesh& mesh, const HalfEdgeCollapse& collapse);

}  // namespace pmesh
