// The largest distance from one surface to another, bounded from below by a distance that occurs
// and from above by proof (core/measure/face_bound.h).
#pragma once

#include <cstdint>
#include <vector>

#include "core/measure/bound_memory.h"
#include "core/measure/surface.h"

namespace pmesh {

class FaceBounder;

/// One direction: from `source` to `target`. sweep() first, then refine(); in between, what another
/// direction has reached may be given, if only the larger of both is wanted.
///
/// Deterministic, whatever the threads.
class DistanceBound {
 public:
  /// All of them must outlive the object; `memory` may be null.
  DistanceBound(const Surface& source, const Surface& target, double tolerance, unsigned threads,
                BoundMemory* memory)
      : source_(source),
        target_(target),
        tolerance_(tolerance),
        threads_(threads),
        memory_(memory) {}

  /// Takes note of a distance that occurs.
  void reach(double distance) { reached_ = reached_ < distance ? distance : reached_; }
  /// Bounds all faces for which little work suffices.
  void sweep();
  /// Bounds the rest, to within the tolerance above the largest distance reached, if a bounded
  /// effort per face suffices.
  void refine();

  /// The largest distance known to occur, and the bound, which may be below it: it speaks of this
  /// direction alone.
  double reached() const { return reached_; }
  double bound() const { return bound_; }

 private:
  struct OpenFace {
    std::uint32_t face, hint;
  };
  struct Part;  // of a sweep or refinement
  void sweep_node(std::uint32_t level, std::uint32_t node, Part& part) const;
  void sweep_face(std::uint32_t face, Part& part) const;
  bool bound_face(std::uint32_t face, std::uint32_t hint, std::uint32_t most_cuts,
                  Part& part) const;
  std::uint32_t hint_for(std::uint32_t face, const FaceBounder& bounder) const;
  void take(const std::vector<Part>& parts);

  const Surface& source_;
  const Surface& target_;
  double tolerance_;
  unsigned threads_;
  BoundMemory* memory_;
  double reached_ = 0, bound_ = 0;
  std::vector<OpenFace> open_;
};

}  // namespace pmesh
