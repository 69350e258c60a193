// A bound that no point of a face exceeds in its distance to a surface.
//
// The distance to one triangle, a convex set, is a convex function: over a convex piece of the face
// it is largest at a corner of the piece. So the largest distance of a corner to one triangle
// bounds that of the whole piece to the surface; and the distance of one point plus the piece's
// radius does too, distances being 1-Lipschitz. A piece for which neither is good enough, even if a
// triangle's neighbours help it, is cut: along the sides of the prism over a triangle that is near
// or, if it is large against that, in the middle.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/measure/polygon.h"
#include "core/measure/surface.h"

namespace pmesh {

struct FaceDistance {
  std::uint32_t face;
  double distance;
};

/// Bounds the faces of one surface, one after another, by another surface.
///
/// `reached` is the largest distance met at any point so far, and bounds are only refined until
/// they are at most `good_enough()`: a little above it.
class FaceBounder {
 public:
  /// `reached` is a distance known to occur.
  FaceBounder(const Surface& target, double tolerance, double reached)
      : target_(target), tolerance_(tolerance), reached_(reached) {}

  double reached() const { return reached_; }
  double good_enough() const;
  /// Where `reached` is met, if that is more than it was at first.
  std::optional<Vec3d> farthest() const { return farthest_; }

  /// A face of the target that was near to what was bounded last.
  std::uint32_t last_near() const { return last_near_; }

  /// No point of `face` is farther than this. Found by at most `most_cuts` cuts; good enough if
  /// those suffice. `hint` is a face of the target, better a near one.
  double bound(const Corners& face, std::uint32_t hint, std::uint32_t most_cuts);

  /// Of the face bounded last: every point of it is that near to one of these faces of the target,
  /// which may be named more than once.
  std::span<const FaceDistance> near_faces() const { return near_faces_; }

 private:
  struct Estimate {
    std::uint32_t near = kNoIndex;  // the face by which it was found, or one to cut by
    double bound = 0;
    std::array<std::uint32_t, 3> beyond = {kNoIndex, kNoIndex, kNoIndex};  // neighbours it needed
  };
  bool is_good(const Estimate& estimate) const { return estimate.bound <= good_enough(); }
  struct Piece {
    ConvexPolygon polygon;
    std::uint32_t near = kNoIndex;  // a face near its center
    double bound = 0;
    friend bool operator<(const Piece& a, const Piece& b) { return a.bound < b.bound; }
  };
  void reach(const NearestFace& nearest, Vec3d point);
  Estimate estimate(const ConvexPolygon& polygon, std::uint32_t hint);
  Estimate estimate_around(std::span<const Vec3d> corners, std::uint32_t face) const;
  void reach_corners(std::span<const Vec3d> corners, std::uint32_t face);
  void push(const ConvexPolygon& polygon, std::uint32_t hint);
  void accept(const Estimate& estimate);
  void split(const Piece& piece);
  bool split_by_prism(const ConvexPolygon& polygon, std::uint32_t face, int steps_left);
  std::uint32_t with_prism(std::uint32_t face) const;

  const Surface& target_;
  double tolerance_;
  double reached_;
  std::optional<Vec3d> farthest_;
  std::uint32_t last_near_ = 0;
  std::vector<Piece> pieces_;  // not yet good enough: a heap, the worst is cut next
  double bound_ = 0;           // of the pieces that are
  std::vector<FaceDistance> near_faces_;
};

}  // namespace pmesh
