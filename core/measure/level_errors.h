// The error index: how far each level of detail (LOD) is from the original surface.
//
// The maximum is not sampled but bounded: no point of either surface is farther from the other than
// `max_error`, and some point is nearly as far (kErrorTolerance below it). So compare_surfaces(),
// which looks at points, never finds more, whatever its samples and seed.
//
// What is known of the faces beforehand is used: only those that might be farther than any distance
// met are looked at.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/measure/face_errors.h"
#include "core/measure/sampled_distance.h"
#include "core/measure/sampling.h"
#include "core/measure/surface.h"

namespace pmesh {

/// max_error is at most this much above the distance of some point, as a fraction of it (but see
/// core/measure/distance_bound.h on the bounded effort).
inline constexpr double kErrorTolerance = 0.2;

/// Two-sided, in the mesh's units.
struct LevelError {
  double max_error = 0;  ///< The larger of both directions' maxima, rounded up.
  double rms_error = 0;  ///< The larger of both directions' root mean squares, sampled.
};

struct LevelErrorOptions {
  /// A direction and level, for rms_error; 0: 131,072, or 8,192 for 200,000 faces and more.
  std::uint32_t samples = 0;
  unsigned threads = 1;  ///< The errors do not depend on it.
};

/// Threads: one at a time; uses `threads` itself.
class LevelErrors {
 public:
  /// `original` is copied; `frame` is that of its box (unit_frame()). Preconditions: it has a
  /// triangle, indices are in range, positions finite. About 80 bytes a face of the original, and
  /// 90 a face of the largest LOD.
  LevelErrors(MeshView original, const UnitFrame& frame, const LevelErrorOptions& options);

  /// The error of an LOD, whose positions are to be those that a user gets (rounded as exported).
  /// Preconditions as above; the LOD is near the original's bounding box. `known` holds what is
  /// known of its faces, and more is known afterwards.
  /// Fastest if LODs come from fine to coarse and their faces of one number are in one place.
  LevelError measure(MeshView lod, FaceErrors& known);

 private:
  // Where the original was far from LODs before, and LODs from the original: it is often the same
  // with the next.
  struct FarPoints {
    std::vector<Vec3d> of_original, of_lods;
  };
  class Level;
  Surface surface_of(MeshView lod);
  SurfaceDistance sample_original(const Surface& lod);

  UnitFrame frame_;
  LevelErrorOptions options_;
  std::unique_ptr<const Surface> original_;  // where it is, so that the sampler may be moved
  SurfaceSampler samples_;                   // of the original

  // Of the LOD before, by the numbers given, for the next one:
  SpatialOrder order_;
  std::vector<std::uint32_t> near_samples_;  // the faces nearest to the original's samples
  FarPoints far_;
};

}  // namespace pmesh
