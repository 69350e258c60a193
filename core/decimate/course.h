// How far a decimation has come, and its report: what both schedules share. Private to
// core/decimate.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/decimate/decimate.h"
#include "core/decimate/legality.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// Refers to both arguments, which must outlive it.
class Course {
 public:
  Course(const WorkingMesh& work, const DecimateOptions& options)
      : work_(work), options_(options), guess_(collapses_to_go()) {}

  std::uint32_t faces() const { return work_.mesh().live_faces(); }
  bool is_done() const { return faces() <= options_.base_faces; }
  std::uint64_t collapses() const { return work_.log().collapses.size(); }

  /// An estimate: vertices go in proportion to faces.
  std::uint64_t collapses_to_go() const {
    if (is_done()) return 0;
    const std::uint64_t vertices = work_.mesh().live_vertices();
    return 1 + vertices * (faces() - options_.base_faces) / faces();
  }

  /// Whatever is collapsed, fewer do not reach the target.
  std::uint64_t least_collapses_to_go() const {
    return is_done() ? 0 : (1 + faces() - options_.base_faces) / 2;
  }

  void show_progress() {
    guess_ = std::max(guess_, collapses());
    if (options_.progress) options_.progress(collapses(), guess_);
  }

  /// Above the target, an empty queue means that only what fails a test is left. Nothing else can
  /// have become legal unnoticed, because a link condition only comes to hold if the common
  /// neighbour in its way, or a vertex between, is removed: then the candidate's ends are
  /// neighbours of that vertex. So tests are given up one by one, and `start_again` collapses what
  /// can be collapsed then.
  template <class Candidates, class StartAgain>
  void run_relaxed(Candidates& candidates, const StartAgain& start_again) {
    while (!is_done()) {
      const std::optional<Relaxation> relaxed = candidates.relax();
      if (!relaxed) return;
      const std::uint32_t faces_before = faces();
      start_again();
      if (faces() < faces_before) note(*relaxed, faces_before);
    }
  }

  DecimationReport report() const {
    DecimationReport report = report_;
    report.faces = faces();
    report.vertices = work_.mesh().live_vertices();
    return report;
  }

 private:
  void note(Relaxation relaxed, std::uint32_t faces_before) {
    if (relaxed == Relaxation::turn) return;
    std::optional<std::uint32_t>& first = relaxed == Relaxation::planarity
                                              ? report_.planarity_relaxed_at_faces
                                              : report_.fold_over_relaxed_at_faces;
    if (!first) first = faces_before;
  }

  const WorkingMesh& work_;
  const DecimateOptions& options_;
  std::uint64_t guess_;
  DecimationReport report_;  // but for its counts
};

}  // namespace pmesh
