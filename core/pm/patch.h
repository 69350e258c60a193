// The patch of a vertex split: the fan of faces that the new vertex takes over, measured in a local
// frame, and the new vertex's position as the patch predicts it. Everything is read from the mesh
// as it was before the split's batch; all arithmetic is in integers (docs/pm-format.md, "Patch").
//
// Threads: plain values; no shared state.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/pm/fan.h"
#include "core/pm/fixed_point.h"
#include "core/pm/int4.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// Local coordinates are relative to the kept vertex, in eighths of the lattice's step, shifted
/// right so far that the patch's polygon fits kLocalBits.
inline constexpr int kLocalBits = 14;
inline constexpr std::int64_t kLocalReach = std::int64_t{1} << (kLocalBits + 3);

/// Fans that are predicted alike: interior ones of up to 2, 3, 4, and more faces; those on borders.
inline constexpr std::size_t kFanClasses = 5;
inline constexpr std::size_t kBorderFans = kFanClasses - 1;

/// How a batch predicts: weights in units of 1/32, found by the encoder and sent with the batch.
struct Predictor {
  /// Of a patch's features, tangential and normal to it.
  struct Weights {
    std::array<std::int64_t, 4> tangential;  ///< kept, cut, opposite, area.
    std::array<std::int64_t, 2> normal;      ///< kept, opposite.
  };
  std::array<Weights, kFanClasses> fans;  ///< By Patch::fan_class().
  std::array<std::int64_t, 2> mirrored;   ///< Of a relocated kept vertex: tangential, normal.
};

struct Patch {
  /// Gathers the patch of a split that `mesh` has `fan` for.
  void gather(const RefinableMesh& mesh, const Fan& fan);

  std::size_t fan_class() const;  ///< Below kFanClasses.

  /// Of `point`, in local coordinates, clamped to kLocalReach.
  Vec3l local(Vec3i point) const;

  SplitKind kind = SplitKind::interior;
  std::uint32_t faces = 0;  ///< Of the fan; 0 for an ear.
  Vec3i kept;               ///< On the lattice; the local frame's origin.
  int shift = 0;
  /// The fan's other vertices, kept's neighbours, ccw (border_last: cw): one more than faces.
  std::span<const Int4> polygon() const { return {outline_.data() + 1, std::size_t{faces} + 1}; }
  std::array<Vec3i, kMaxMovedFaces> crosses;  ///< Twice the faces' area vectors.

  Vec3l normal;                 ///< At most kLocalBits bits; never zero.
  std::int64_t normal_squared;  ///< Its length's square, and its length.
  std::int64_t normal_length;
  std::int64_t area;  ///< The sum of the crosses' manhattan lengths.

  Vec3l centroid;  ///< Of polygon and kept.
  /// Features, relative to the centroid: the kept vertex, the middle of the cut neighbours, the
  /// mean of the parallelograms over the patch's outer edges, the fan's centre of area.
  std::array<Vec3l, 4> features;
  std::int64_t radius_squared;     ///< Mean squared distance of polygon and kept to the centroid.
  std::int64_t flatness;           ///< Mean distance of polygon and kept to the tangential plane.
  std::int64_t opposite_flatness;  ///< The same of the parallelograms' ends, to their own mean.

 private:
  void gather_fan(const RefinableMesh& mesh, const Fan& fan);
  void gather_ear(const RefinableMesh& mesh, HalfEdgeId glued_to);
  void measure_polygon();
  void measure_opposites();
  void measure_normal();
  void measure_area_centre();
  void measure_spread();

  // Kept, the polygon, kept again: outer edge e of the fan joins e and e + 1.
  std::array<Int4, kMaxMovedFaces + 3> outline_;
  // Beyond the outer edges that have a face there: the edge, and the face's third corner; once
  // measured, the fourth corner of the parallelogram over that face.
  std::array<std::uint16_t, kMaxMovedFaces + 2> outer_edges_;
  std::array<Int4, kMaxMovedFaces + 2> opposites_;
  std::uint32_t opposite_count_ = 0;
  Int4 sum_;  // of the polygon
  Vec3l opposite_mean_;
};

/// Where the patch expects the new vertex, in local coordinates, and how far off it may be.
struct Prediction {
  Vec3l at;
  int tangential_class;  ///< 0 to 63, half octaves.
  int normal_class;
};
Prediction predict(const Patch& patch, const Predictor& predictor);

/// The same for a relocated kept vertex, once the new vertex is known.
Prediction predict_kept(const Patch& patch, const Predictor& predictor, Vec3i added);

/// What the split at `patch` that adds `added` is about worth, in half octaves: the squared volume
/// between old and new surface over its area. A batch is applied by and large the dearest first.
int split_cost(const Patch& patch, Vec3i added);

}  // namespace pmesh
