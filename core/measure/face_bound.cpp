#include "core/measure/face_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmesh {
namespace {

double longest_edge(const Corners& t) {
  return std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
}

}  // namespace

double FaceBounder::good_enough() const {
  return std::max((1 + tolerance_) * reached_, kNoDistance);
}

FaceBounder::Bound FaceBounder::bound(const Corners& face, std::uint32_t hint,
                                      std::uint32_t most_cuts) {
  constexpr std::uint32_t kCutsOfAnEasyFace = 16;
  bound_ = {};
  pieces_.clear();
  push(ConvexPolygon(face), hint);
  const auto is_good = [&] { return pieces_.empty() || pieces_.front().bound <= good_enough(); };
  for (std::uint32_t cuts = 1; !is_good() && cuts <= most_cuts; ++cuts) {
    std::pop_heap(pieces_.begin(), pieces_.end());
    const Piece piece = pieces_.back();
    pieces_.pop_back();
    split(piece);
    // Perhaps it is a corner that is far.
    if (cuts % kCutsOfAnEasyFace == 0) reach_corners(piece.polygon.corners(), piece.near);
  }
  for (const Piece& piece : pieces_) accept({piece.near, piece.bound});
  return bound_;
}

void FaceBounder::push(const ConvexPolygon& polygon, std::uint32_t hint) {
  if (polygon.empty()) return;
  const Estimate found = estimate(polygon, hint);
  last_near_ = found.near;
  if (found.bound <= good_enough()) return accept(found);
  pieces_.push_back({polygon, found.near, found.bound});
  std::push_heap(pieces_.begin(), pieces_.end());
}

void FaceBounder::accept(const Estimate& estimate) {
  bound_.distance = std::max(bound_.distance, estimate.bound);
  bound_.witnesses.add(target_.given_face(estimate.near));
}

// A bound without a cut, and a face that may serve to cut by: one that is near enough for a smaller
// piece; a nearer one is then not worth its search.
FaceBounder::Estimate FaceBounder::estimate(const ConvexPolygon& polygon, std::uint32_t hint) {
  const double by_hint = distance_to_face(polygon.corners(), hint);
  if (by_hint <= good_enough()) return {hint, by_hint};
  const Vec3d middle = polygon.extent().middle();
  const double radius = polygon.radius_about(middle);
  const auto is_near = [&](double squared) { return 4 * squared <= good_enough() * good_enough(); };
  const auto by = [&](const NearestFace& face) {
    return Estimate{face.face, std::min(std::sqrt(face.squared) + radius,
                                        distance_to_face(polygon.corners(), face.face))};
  };
  const double squared = target_.squared_distance(middle, hint);
  if (is_near(squared)) return {hint, std::sqrt(squared) + radius};
  const NearestFace last{target_.squared_distance(middle, last_near_), last_near_};
  if (is_near(last.squared)) return by(last);
  const NearestFace near = target_.near(middle, last.squared < squared ? last_near_ : hint);
  if (const Estimate found = by(near); found.bound <= good_enough() || is_near(near.squared)) {
    return found;
  }
  const NearestFace nearest = target_.nearest(middle, near.face);
  reach(std::sqrt(nearest.squared));
  return by(nearest);
}

// The largest distance of a corner to `face`; infinite if that is not good enough.
double FaceBounder::distance_to_face(std::span<const Vec3d> corners, std::uint32_t face) const {
  const double enough = good_enough();
  const Corners t = target_.corners(face);
  const TriangleDistance distance(t.a, t.b, t.c);
  double most = 0;
  for (const Vec3d corner : corners) {
    most = std::max(most, distance.squared(corner));
    if (most > enough * enough) return std::numeric_limits<double>::infinity();
  }
  return std::sqrt(most);
}

// Reaches the distances of those corners that are farther than all before.
void FaceBounder::reach_corners(std::span<const Vec3d> corners, std::uint32_t face) {
  for (const Vec3d corner : corners) {
    if (target_.squared_distance(corner, face) <= reached_ * reached_) continue;
    reach(std::sqrt(target_.nearest(corner, face).squared));
  }
}

void FaceBounder::split(const Piece& piece) {
  constexpr double kLarge = 3;
  const ConvexPolygon& polygon = piece.polygon;
  if (!polygon.can_be_cut()) {
    const auto [below, above] = polygon.cut_by_diagonal();
    push(below, piece.near);
    push(above, piece.near);
    return;
  }
  const auto extent = polygon.extent();
  const double longest = longest_edge(target_.corners(piece.near));
  if (length(extent.to - extent.from) < kLarge * longest && split_by_prism(piece)) return;
  const auto [below, above] = polygon.cut({extent.middle(), extent.to - extent.from});
  push(below, piece.near);
  push(above, piece.near);
}

// Cuts off what lies beyond the sides of the prism over the nearest face, widened by so little that
// it does not count. False if there is nothing to cut off.
bool FaceBounder::split_by_prism(const Piece& piece) {
  constexpr double kWidening = 0.1;
  const Corners t = target_.corners(piece.near);
  const Vec3d normal = cross(t.b - t.a, t.c - t.a);
  const std::array<Vec3d, 4> around = {t.a, t.b, t.c, t.a};
  ConvexPolygon rest = piece.polygon;
  bool is_cut = false;
  for (std::size_t k = 0; k < 3 && rest.can_be_cut(); ++k) {
    const Vec3d outwards = cross(around[k + 1] - around[k], normal);
    const double size = length(outwards);
    if (!(size > 0)) continue;
    const double margin = kWidening * good_enough();
    const Plane side{around[k] + (margin / size) * outwards, outwards};
    const auto heights = rest.heights(side);
    if (heights.high <= margin * size) continue;  // not worth a cut
    if (heights.low >= -margin * size) break;     // nothing of it is over the face
    const auto [below, above] = rest.cut(side);
    const std::uint32_t beyond = target_.neighbour(piece.near, k);
    push(above, beyond == kNoIndex ? piece.near : beyond);
    rest = below;
    is_cut = true;
  }
  if (is_cut) push(rest, piece.near);
  return is_cut;
}

}  // namespace pmesh
