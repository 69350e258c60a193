// Which fan of an interior split's kept vertex the new vertex takes over: given how many faces it
// has, the runs of that many free faces are ranked by their likeness to what a collapse leaves
// behind, long spokes inside and short ones at the cuts. Integer arithmetic (docs/pm-format.md,
// "Cut neighbours").
//
// Threads: plain values; no shared state.
#pragma once

#include <array>
#include <cstdint>

#include "core/pm/fixed_point.h"
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
  /// False if `v` has more than kMaxRankedFaces faces.
  bool gather(const RefinableMesh& mesh, VertexId v);

  std::uint32_t faces() const { return faces_; }
  bool border() const { return border_; }
  /// Outgoing half-edge of face i, and the face.
  HalfEdgeId half_edge(std::uint32_t i) const { return half_edges_[i]; }
  FaceId face(std::uint32_t i) const { return HalfEdgeMesh::face(half_edges_[i]); }

  /// Looks at which faces are free. Returns the length of the longest run of free faces that an
  /// interior split may take over.
  std::uint32_t find_runs(const std::vector<std::uint8_t>& covered);

  struct Candidate {
    std::int64_t score;   ///< In units that lead() knows.
    std::uint32_t first;  ///< Face of the ring.
  };
  /// The runs of `length` free faces, likeliest first; ties by first. Precondition: find_runs()
  /// returned at least `length` > 0.
  std::span<const Candidate> rank(const RefinableMesh& mesh, std::uint32_t length,
                                  const FanWeights& weights);

  /// What a weight of one adds to the score of the run of `length` faces from `first`, by weight.
  /// Precondition: rank() was called with that length.
  std::array<std::int64_t, 3> terms(std::uint32_t first, std::uint32_t length) const;

  /// By how much candidate `a` of rank() is likelier than `b`, in sixteenths of a natural logarithm
  /// times `factor`.
  std::int64_t score_unit() const { return score_unit_; }
  std::int64_t lead(const Candidate& a, const Candidate& b, std::int64_t factor) const {
    return factor * (a.score - b.score) / score_unit_;
  }

 private:
  static constexpr std::uint32_t kMost = kMaxRankedFaces;
  /// x, y, z and length.
  using Spoke [[gnu::vector_size(16)]] = std::int32_t;

  void measure_spokes(const RefinableMesh& mesh);

  VertexId centre_;
  std::uint32_t faces_ = 0;
  bool border_ = false;
  std::array<HalfEdgeId, kMost> half_edges_;
  std::array<std::uint8_t, 2 * kMost> run_;  // free faces from face i on, ccw
  // Sums over the spokes before spoke i; of a closed ring twice around.
  std::array<Spoke, 2 * kMost + 2> sums_;
  std::int64_t mean_length_ = 1;
  std::int64_t score_unit_ = 1;
  std::array<Candidate, kMost> candidates_;
};

}  // namespace pmesh
