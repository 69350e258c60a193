#include "core/measure/face_bound.h"

#include <algorithm>
#include <cmath>

namespace pmesh {
namespace {

// A bounded effort for one face.
constexpr std::uint32_t kMostCuts = 20'000;

double longest_edge(const Corners& t) {
  return std::max({length(t.b - t.a), length(t.c - t.b), length(t.a - t.c)});
}

}  // namespace

double FaceBounder::good_enough() const {
  return std::max((1 + tolerance_) * reached_, kNoDistance);
}

double FaceBounder::distance_to_face(std::span<const Vec3d> corners, std::uint32_t face) const {
  double most = 0;
  for (const Vec3d corner : corners) {
    most = std::max(most, target_.squared_distance(corner, face));
  }
  return std::sqrt(most);
}

void FaceBounder::reach_corners(std::span<const Vec3d> corners, std::uint32_t face) {
  for (const Vec3d corner : corners) {
    if (std::sqrt(target_.squared_distance(corner, face)) <= reached_) continue;
    reach(std::sqrt(target_.nearest(corner, face).squared));
  }
}

FaceBounder::Bound FaceBounder::bound(const Corners& face, std::uint32_t hint) {
  pieces_.clear();
  push(ConvexPolygon(face), hint);
  for (std::uint32_t cuts = 0; cuts < kMostCuts && pieces_.front().bound > good_enough(); ++cuts) {
    split(pop());
  }
  Bound bound;
  bound.distance = pieces_.front().bound;
  for (const Piece& piece : pieces_) bound.witnesses.add(target_.given_face(piece.nearest));
  return bound;
}

void FaceBounder::push(const ConvexPolygon& polygon, std::uint32_t hint) {
  if (polygon.empty()) return;
  const Vec3d center = polygon.center();
  const NearestFace nearest = target_.nearest(center, hint);
  const double at_center = std::sqrt(nearest.squared);
  reach(at_center);
  const std::span<const Vec3d> corners = polygon.corners();
  const double radius = length(corners[polygon.farthest_corner(center)] - center);
  const double bound = std::min(at_center + radius, distance_to_face(corners, nearest.face));
  pieces_.push_back({polygon, nearest.face, bound});
  std::push_heap(pieces_.begin(), pieces_.end());
}

FaceBounder::Piece FaceBounder::pop() {
  std::pop_heap(pieces_.begin(), pieces_.end());
  const Piece piece = pieces_.back();
  pieces_.pop_back();
  return piece;
}

void FaceBounder::split(const Piece& piece) {
  constexpr double kLarge = 1.5;
  const ConvexPolygon& polygon = piece.polygon;
  if (!polygon.can_be_cut()) {
    const auto [below, above] = polygon.cut_by_diagonal();
    push(below, piece.nearest);
    push(above, piece.nearest);
    return;
  }
  const Vec3d center = polygon.center();
  const Vec3d farthest = polygon.corners()[polygon.farthest_corner(center)];
  const bool is_large =
      length(farthest - center) > kLarge * longest_edge(target_.corners(piece.nearest));
  if (!is_large && split_by_prism(piece)) return;
  const auto [below, above] = polygon.cut({center, farthest - center});
  push(below, piece.nearest);
  push(above, piece.nearest);
}

// Cuts off what lies beyond the sides of the prism over the nearest face, widened by so little that
// it does not count. False if there is nothing to cut off, or nothing else.
bool FaceBounder::split_by_prism(const Piece& piece) {
  constexpr double kWidening = 0.1;
  const double margin = kWidening * good_enough();
  const Corners t = target_.corners(piece.nearest);
  const Vec3d normal = cross(t.b - t.a, t.c - t.a);
  const std::array<Vec3d, 4> around = {t.a, t.b, t.c, t.a};
  std::array<ConvexPolygon, 3> cut_off;
  ConvexPolygon rest = piece.polygon;
  std::size_t parts = 0;
  for (std::size_t k = 0; k < 3 && !rest.empty() && rest.can_be_cut(); ++k) {
    const Vec3d outwards = cross(around[k + 1] - around[k], normal);
    const double size = length(outwards);
    if (!(size > 0)) continue;
    const auto [below, above] = rest.cut({around[k] + (margin / size) * outwards, outwards});
    if (!above.empty()) cut_off[parts++] = above;
    rest = below;
  }
  if (parts == 0 || (parts == 1 && rest.empty())) return false;
  for (std::size_t k = 0; k < parts; ++k) push(cut_off[k], piece.nearest);
  push(rest, piece.nearest);
  return true;
}

}  // namespace pmesh
