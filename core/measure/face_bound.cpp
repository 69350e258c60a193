#include "core/measure/face_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmesh {
namespace {

double longest_edge(const Corners& t) {
  return std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
}

// The sides of a triangle, and the planes through them that stand on it.
class Sides {
 public:
  explicit Sides(const Corners& t)
      : ends_{t.a, t.b, t.c, t.a}, normal_(cross(t.b - t.a, t.c - t.a)) {}

  // Of the side whose plane `p` is farthest beyond.
  std::size_t most_beyond(Vec3d p) const {
    std::size_t most = 0;
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t side = 0; side < 3; ++side) {
      const Vec3d along = ends_[side + 1] - ends_[side];
      const double beyond = height(side, p) / std::sqrt(dot(along, along));
      if (beyond > farthest) {
        farthest = beyond;
        most = side;
      }
    }
    return most;
  }

  // To the side, from where the segment from `p` to `q` crosses its plane, or is nearest to it.
  double squared_distance(std::size_t side, Vec3d p, Vec3d q) const {
    const double from = height(side, p), to = height(side, q);
    const bool is_crossed = (from < 0) != (to < 0);
    const double t = is_crossed ? from / (from - to) : (std::abs(from) < std::abs(to) ? 0.0 : 1.0);
    return squared_distance_to_segment(p + t * (q - p), ends_[side], ends_[side + 1] - ends_[side]);
  }

 private:
  double height(std::size_t side, Vec3d p) const {  // times the length of side and normal
    return dot(p - ends_[side], cross(ends_[side + 1] - ends_[side], normal_));
  }

  std::array<Vec3d, 4> ends_;
  Vec3d normal_;
};

}  // namespace

double FaceBounder::good_enough() const {
  return std::max((1 + tolerance_) * reached_, kNoDistance);
}

void FaceBounder::reach(const NearestFace& nearest, Vec3d point) {
  const double distance = std::sqrt(nearest.squared);
  if (distance <= reached_) return;
  reached_ = distance;
  farthest_ = point;
}

double FaceBounder::bound(const Corners& face, std::uint32_t hint, std::uint32_t most_cuts) {
  constexpr std::uint32_t kCutsOfAnEasyFace = 16;
  bound_ = 0;
  near_faces_.clear();
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
  if (is_good(found)) return accept(found);
  pieces_.push_back({polygon, found.near, found.bound});
  std::push_heap(pieces_.begin(), pieces_.end());
}

void FaceBounder::accept(const Estimate& estimate) {
  bound_ = std::max(bound_, estimate.bound);
  near_faces_.push_back({estimate.near, estimate.bound});
  for (const std::uint32_t face : estimate.beyond) {
    if (face != kNoIndex) near_faces_.push_back({face, estimate.bound});
  }
}

// A bound without a cut, and a face that may serve to cut by: one that is near enough for a smaller
// piece; a nearer one is then not worth its search.
FaceBounder::Estimate FaceBounder::estimate(const ConvexPolygon& polygon, std::uint32_t hint) {
  if (const Estimate around = estimate_around(polygon.corners(), hint); is_good(around)) {
    return around;
  }
  const Vec3d center = polygon.center();
  const double radius = polygon.radius_about(center);
  const auto is_near = [&](double squared) { return 4 * squared <= good_enough() * good_enough(); };
  const auto by = [&](const NearestFace& face) {
    const Estimate around = estimate_around(polygon.corners(), face.face);
    const double by_radius = std::sqrt(face.squared) + radius;
    return is_good(around) ? around : Estimate{face.face, by_radius};
  };
  const double squared = target_.squared_distance(center, hint);
  if (is_near(squared)) return {hint, std::sqrt(squared) + radius};
  const NearestFace last{target_.squared_distance(center, last_near_), last_near_};
  if (is_near(last.squared)) return by(last);
  const NearestFace near = target_.near(center, last.squared < squared ? last_near_ : hint);
  if (const Estimate found = by(near); is_good(found) || is_near(near.squared)) return found;
  const NearestFace nearest = target_.nearest(center, near.face);
  reach(nearest, center);
  return by(nearest);
}

// A bound by a face and its neighbours. Each corner belongs to the face or, if that is too far, to
// the neighbour beyond the side that it is most beyond. Where an edge of the polygon leads from one
// to the other it is cut near their common side, by points near both. So the polygon falls into
// convex parts, each with all its corners near the one face that it belongs to. Infinite if that
// does not work out or is not good enough.
FaceBounder::Estimate FaceBounder::estimate_around(std::span<const Vec3d> corners,
                                                   std::uint32_t face) const {
  constexpr std::size_t kInside = 3;
  const double enough = good_enough() * good_enough();
  const Corners t = target_.corners(face);
  const TriangleDistance distance(t.a, t.b, t.c);
  const Sides sides(t);
  std::array<std::size_t, ConvexPolygon::kMaxCorners> side_of;
  Estimate estimate{face, 0};
  const auto is_within = [&](double squared) {
    estimate.bound = std::max(estimate.bound, squared);
    return squared <= enough;
  };
  const auto failed = Estimate{face, std::numeric_limits<double>::infinity()};

  for (std::size_t i = 0; i < corners.size(); ++i) {
    side_of[i] = kInside;
    const double squared = distance.squared(corners[i]);
    if (squared <= enough) {
      is_within(squared);
      continue;
    }
    const std::size_t side = side_of[i] = sides.most_beyond(corners[i]);
    const std::uint32_t beyond = target_.neighbour(face, side);
    if (beyond == kNoIndex) return failed;
    if (!is_within(target_.squared_distance(corners[i], beyond))) return failed;
    estimate.beyond[side] = beyond;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t next = i + 1 < corners.size() ? i + 1 : 0;
    if (side_of[i] == side_of[next]) continue;
    for (const std::size_t side : {side_of[i], side_of[next]}) {
      if (side == kInside) continue;
      if (!is_within(sides.squared_distance(side, corners[i], corners[next]))) return failed;
    }
  }
  estimate.bound = std::sqrt(estimate.bound);
  return estimate;
}

// Reaches the distances of those corners that are farther than all before.
void FaceBounder::reach_corners(std::span<const Vec3d> corners, std::uint32_t face) {
  for (const Vec3d corner : corners) {
    if (target_.squared_distance(corner, face) <= reached_ * reached_) continue;
    reach(target_.nearest(corner, face), corner);
  }
}

// A face that has a prism to cut by: `face` or, if that is too thin, one beyond its longest side.
std::uint32_t FaceBounder::with_prism(std::uint32_t face) const {
  constexpr int kMostSteps = 4;
  for (int step = 0; step < kMostSteps; ++step) {
    const Corners t = target_.corners(face);
    if (TriangleDistance(t.a, t.b, t.c).has_normal()) break;
    const std::array<double, 3> sides = {length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)};
    const auto longest = std::max_element(sides.begin(), sides.end()) - sides.begin();
    const std::uint32_t beyond = target_.neighbour(face, static_cast<std::size_t>(longest));
    if (beyond == kNoIndex) break;
    face = beyond;
  }
  return face;
}

void FaceBounder::split(const Piece& piece) {
  constexpr double kLarge = 5;
  constexpr int kMostSteps = 2;
  const ConvexPolygon& polygon = piece.polygon;
  if (!polygon.can_be_cut()) {
    const auto [below, above] = polygon.cut_by_diagonal();
    push(below, piece.near);
    push(above, piece.near);
    return;
  }
  const auto extent = polygon.extent();
  const std::uint32_t near = with_prism(piece.near);
  const double longest = longest_edge(target_.corners(near));
  if (length(extent.to - extent.from) < kLarge * longest &&
      split_by_prism(polygon, near, kMostSteps))
    return;
  const auto [below, above] = polygon.cut({extent.middle(), extent.to - extent.from});
  push(below, piece.near);
  push(above, piece.near);
}

// Cuts off what lies beyond the sides of the prism over a face, widened by so little that
// it does not count; or over a neighbour, if nothing is over that face. False if there is nothing
// to cut off.
bool FaceBounder::split_by_prism(const ConvexPolygon& polygon, std::uint32_t face, int steps_left) {
  constexpr double kWidening = 0.1;
  const Corners t = target_.corners(face);
  const Vec3d normal = cross(t.b - t.a, t.c - t.a);
  const std::array<Vec3d, 4> around = {t.a, t.b, t.c, t.a};
  ConvexPolygon rest = polygon;
  bool is_cut = false;
  for (std::size_t k = 0; k < 3 && rest.can_be_cut(); ++k) {
    const Vec3d outwards = cross(around[k + 1] - around[k], normal);
    const double size = length(outwards);
    if (!(size > 0)) continue;
    const double margin = kWidening * good_enough();
    const Plane side{around[k] + (margin / size) * outwards, outwards};
    const auto heights = rest.heights(side);
    if (heights.high <= margin * size) continue;  // not worth a cut
    const std::uint32_t beyond = target_.neighbour(face, k);
    if (heights.low >= -margin * size) {  // nothing of it is over the face
      const bool may_step = !is_cut && steps_left > 0 && beyond != kNoIndex;
      if (may_step) return split_by_prism(polygon, beyond, steps_left - 1);
      break;
    }
    const auto [below, above] = rest.cut(side);
    push(above, beyond == kNoIndex ? face : beyond);
    rest = below;
    is_cut = true;
  }
  if (is_cut) push(rest, face);
  return is_cut;
}

}  // namespace pmesh
