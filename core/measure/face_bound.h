// A bound that no point of a face exceeds in its distance to a surface.
//
// The distance to one face of the surface, a convex set, is a convex function: over a convex piece
// it is largest at a corner of the piece. So for any face f, the largest distance from a corner of
// the piece to f bounds the distance of the whole piece to the surface; and the distance at one
// point plus the piece's radius does too, distances being 1-Lipschitz. A piece for which neither is
// good enough is cut: along the sides of the prism over its nearest face, or, if it is large
// against that face, in the middle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/measure/bound_memory.h"
#include "core/measure/polygon.h"
#include "core/measure/surface.h"

namespace pmesh {

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
  void reach(double distance) {
    if (distance > reached_) reached_ = distance;
  }

  /// The largest distance of a corner to `face`.
  double distance_to_face(std::span<const Vec3d> corners, std::uint32_t face) const;
  /// Reaches the distances of those corners that `face` does not show to be near.
  void reach_corners(std::span<const Vec3d> corners, std::uint32_t face);

  /// Faces of the target, as its given numbers.
  struct Bound {
    double distance = 0;
    Witnesses witnesses;
  };
  /// A bound that is good enough, or as good as a bounded effort makes it. `hint` is a face that
  /// may be near.
  Bound bound(const Corners& face, std::uint32_t hint);

 private:
  struct Piece {
    ConvexPolygon polygon;
    std::uint32_t nearest = kNoIndex;  // the face nearest to its center
    double bound = 0;
    friend bool operator<(const Piece& a, const Piece& b) { return a.bound < b.bound; }
  };
  void push(const ConvexPolygon& polygon, std::uint32_t hint);
  Piece pop();
  void split(const Piece& piece);
  bool split_by_prism(const Piece& piece);

  const Surface& target_;
  double tolerance_;
  double reached_;
  std::vector<Piece> pieces_;  // a heap: the one with the largest bound is cut next
};

}  // namespace pmesh
