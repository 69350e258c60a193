// The largest distance from one surface to another, bounded from below by a distance that occurs
// and from above by proof (core/measure/face_bound.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/measure/face_bound.h"
#include "core/measure/face_marks.h"
#include "core/measure/surface.h"

namespace pmesh {

/// Where to keep what is proven, face by face, or null. A face may be named more than once.
struct BoundRecord {
  /// No point of a face of the source is farther from the target: the least named holds.
  std::vector<FaceDistance>* of_source = nullptr;
  /// Every point of the source that was looked at is near one of these faces of the target.
  std::vector<FaceDistance>* of_target = nullptr;
};

/// One direction: from `source` to `target`.
///
/// Deterministic, whatever the threads.
class DistanceBound {
 public:
  /// Looks at the faces of the source in `marks`, or at all if that is null. All that is given must
  /// outlive the object.
  DistanceBound(const Surface& source, const Surface& target, double tolerance, unsigned threads,
                const FaceMarks* marks = nullptr, BoundRecord record = {})
      : source_(source),
        target_(target),
        tolerance_(tolerance),
        threads_(threads),
        marks_(marks),
        record_(record) {}

  /// Takes note of a distance that occurs.
  void reach(double distance) { reached_ = reached_ < distance ? distance : reached_; }
  /// Bounds the faces, to within the tolerance above the largest distance reached, if a bounded
  /// effort per face suffices.
  void find() {
    sweep();
    refine();
  }

  /// The largest distance known to occur, and the bound, which may be below it: it speaks of the
  /// faces looked at.
  double reached() const { return reached_; }
  /// The point of the source where `reached` was met, if find() did.
  std::optional<Vec3d> farthest() const { return farthest_; }
  double bound() const { return bound_; }

 private:
  struct OpenFace {
    std::uint32_t face, hint;
  };
  struct Part;  // of a sweep or refinement
  void sweep();
  void sweep_node(std::uint32_t level, std::uint32_t node, bool all_marked, Part& part) const;
  bool bound_node(std::uint32_t level, std::uint32_t node, Part& part) const;
  void sweep_face(std::uint32_t face, Part& part) const;
  bool bound_face(std::uint32_t face, std::uint32_t hint, std::uint32_t most_cuts,
                  Part& part) const;
  void refine();
  std::vector<Part> parts(std::size_t count) const;
  void take(const std::vector<Part>& parts);

  const Surface& source_;
  const Surface& target_;
  double tolerance_;
  unsigned threads_;
  const FaceMarks* marks_;
  BoundRecord record_;
  double reached_ = 0, bound_ = 0;
  std::optional<Vec3d> farthest_;
  std::vector<OpenFace> open_;
};

}  // namespace pmesh
