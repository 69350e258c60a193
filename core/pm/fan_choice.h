// Which fan of an interior split's kept vertex the new vertex takes over: given how many faces it
// has, the runs of that many free faces are ranked by their likeness to what a collapse leaves
// behind, long spokes inside and short ones at the cuts. Integer arithmetic (docs/pm-format.md,
// "Cut neighbours").
//
// Threads: plain values; no shared state.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/pm/fixed_point.h"
#include "core/pm/int4.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// Around a vertex with more faces, the first face of a fan is named outright.
inline constexpr std::uint32_t kMaxRankedFaces = 64;

/// Weights of the ranking, in sixteenths, sent with each batch.
struct FanWeights {
  std::array<std::int64_t, 3> of;  ///< Inner spokes' length, cut spokes' length, centre's distance.
};

/// The faces around a vertex, ccw: of an interior vertex from its face with the smallest id, of a
/// border vertex from the border.
class VertexRing {
 public:
  /// Looks which of its faces are free, too: `covered` has a 0 for those, a 1 for others, by face.
  /// False, and nothing else may be asked, if `v` has more than kMaxRankedFaces faces.
  bool gather(const RefinableMesh& mesh, VertexId v, const std::vector<std::uint8_t>& covered);

  std::uint32_t faces() const { return faces_; }
  bool border() const { return border_; }
  /// Outgoing half-edge of face i, and the face.
  HalfEdgeId half_edge(std::uint32_t i) const { return half_edges_[walked(i)]; }
  FaceId face(std::uint32_t i) const { return HalfEdgeMesh::face(half_edge(i)); }
  bool is_free(std::uint32_t i) const { return (free_ >> walked(i) & 1) != 0; }
  /// The half-edges of `length` faces from face `first` on.
  std::span<const HalfEdgeId> run(std::uint32_t first, std::uint32_t length) const {
    return std::span(half_edges_).subspan(walked(first), length);
  }

  /// Finds the runs of free faces that an interior split may take over. Returns the longest one's
  /// length.
  std::uint32_t find_runs();

  /// Scores the runs of `length` free faces: the higher, the likelier. What is below is about
  /// these. Precondition: find_runs() found one.
  void score(std::uint32_t length, const FanWeights& weights);

  /// A run and its score in one number: the likelier one has the larger; ties go to the run that
  /// comes first in the ring.
  using Candidate = std::int64_t;
  static constexpr Candidate kNone = -(Candidate{1} << 60), kAll = Candidate{1} << 60;
  static std::uint32_t first_face(Candidate c) {
    return kMost - 1 - static_cast<std::uint32_t>(c & (kMost - 1));
  }
  /// All that were scored.
  std::span<const Candidate> candidates() const { return {candidates_.data(), candidate_count_}; }
  /// The three likeliest below `bound`, likeliest first; kNone for those that there are not.
  std::array<Candidate, 3> likeliest(Candidate bound = kAll) const;

  /// By how much candidate `a` is likelier than `b`, in sixteenths of a natural logarithm times
  /// `factor`.
  std::int64_t lead(Candidate a, Candidate b, std::int64_t factor) const {
    return factor * ((a >> kFirstBits) - (b >> kFirstBits)) / score_unit_;
  }
  std::int64_t score_unit() const { return score_unit_; }
  /// What a weight of one adds to the score of the run from face `first`, by weight.
  std::array<std::int64_t, 3> terms(std::uint32_t first) const;

 private:
  static constexpr std::uint32_t kMost = kMaxRankedFaces;
  static constexpr int kFirstBits = 6;
  static_assert(kMost == 1 << kFirstBits);

  /// Of a run: inner spokes' lengths, cut spokes' lengths, how far the sum of all spokes reaches.
  struct Sums {
    std::int64_t inner, cut, distance;
  };

  // Where face i stands in the order of the walk: a closed ring is walked from any face on.
  std::uint32_t walked(std::uint32_t i) const {
    const std::uint32_t at = start_ + i;
    return at - (at >= faces_ ? faces_ : 0);
  }
  void measure_spokes();
  Sums sums(std::uint32_t at) const;
  std::array<std::int64_t, 3> units() const;  // of scores, by weight

  std::uint32_t faces_ = 0, start_ = 0;
  bool border_ = false;
  // All by place in the walk; a closed ring goes on a second time.
  std::uint64_t free_ = 0;  // faces, bit by bit
  std::array<HalfEdgeId, 2 * kMost> half_edges_;
  std::array<Int4, kMost + 1> spokes_;
  Int4 reach_;                                 // the bits of all their coordinates' magnitudes
  std::array<std::uint64_t, kMost + 1> runs_;  // of that many free faces: where they begin
  // Sums over the spokes before, of vectors and of lengths.
  std::array<Int4, 2 * kMost + 2> sums_;
  std::array<std::int32_t, 2 * kMost + 2> length_sums_;
  std::int64_t mean_length_ = 1;
  std::uint32_t length_ = 1;  // of the runs scored
  std::int64_t score_unit_ = 1;
  std::uint32_t candidate_count_ = 0;
  std::array<Candidate, kMost> candidates_;
};

}  // namespace pmesh
