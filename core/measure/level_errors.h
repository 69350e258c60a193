// The error index: how far each level of detail (LOD) is from the original surface.
//
// The maximum is not sampled but bounded: no point of either surface is farther from the other than
// `max_error`, and some point is nearly as far (kErrorTolerance below it). So compare_surfaces(),
// which looks at points, never finds more, whatever its samples and seed.
//
// Made for a sequence of nested LODs: what is known of faces that have not changed since the level
// before is not computed again (core/measure/bound_memory.h). The same sequence of LODs has the
// same errors; in another, max_error may differ within its tolerance.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/result.h"
#include "core/measure/bound_memory.h"
#include "core/measure/sampling.h"
#include "core/measure/surface.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// max_error is at most this much above the distance of some point, as a fraction of it (but see
/// core/measure/distance_bound.h on the bounded effort).
inline constexpr double kErrorTolerance = 0.18;

/// Two-sided, in the mesh's units.
struct LevelError {
  double max_error = 0;  ///< The larger of both directions' maxima, rounded up.
  double rms_error = 0;  ///< The larger of both directions' root mean squares, sampled.
};

struct LevelErrorOptions {
  /// A direction and level, for rms_error; 0: 131,072, or 16,384 for 200,000 faces and more.
  std::uint32_t samples = 0;
  unsigned threads = 1;  ///< The errors do not depend on it.
};

/// Threads: one at a time; uses `threads` itself.
class LevelErrors {
 public:
  /// Fails (bad_input) if the mesh is too large to be measured. `original` is copied.
  /// Preconditions: it has a triangle, indices are in range, positions finite. About 120 bytes a
  /// face of the original, and 150 a face of the largest LOD.
  static Result<LevelErrors> of(MeshView original, const LevelErrorOptions& options);

  /// The error of an LOD, whose positions are to be those that a user gets (rounded as exported).
  /// Preconditions as above; the LOD is near the original's bounding box. Fast if LODs come from
  /// coarse to fine or back and faces that stay keep their numbers.
  LevelError measure(MeshView lod);

 private:
  LevelErrors(MeshView original, const UnitFrame& frame, const LevelErrorOptions& options);
  void note_changes(MeshView lod);
  double bound_of_maximum(const Surface& lod, double reached);

  UnitFrame frame_;
  LevelErrorOptions options_;
  std::unique_ptr<const Surface> original_;  // where it is, so that the sampler may be moved
  SurfaceSampler samples_;                   // of the original

  std::uint32_t level_ = 0;                // counts the calls of measure()
  IndexedMesh previous_;                   // the LOD before
  std::vector<std::uint32_t> changed_at_;  // by face of the LODs: the level when it last changed
  BoundMemory forward_, backward_;
};

}  // namespace pmesh
