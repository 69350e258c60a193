#include "core/measure/patch_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/measure/point_triangle.h"
#include "core/measure/polygon.h"

namespace pmesh {
namespace {

// A face to which pieces are brought.
struct Tile {
  explicit Tile(const Corners& t)
      : distance(t.a, t.b, t.c),
        sides{side(t.a, t.b, cross(t.b - t.a, t.c - t.a)),
              side(t.b, t.c, cross(t.b - t.a, t.c - t.a)),
              side(t.c, t.a, cross(t.b - t.a, t.c - t.a))} {}

  // The plane on a side that stands on the face.
  static Plane side(Vec3d from, Vec3d to, Vec3d normal) { return {from, cross(to - from, normal)}; }

  TriangleDistance distance;
  std::array<Plane, 3> sides;
};

// Cuts faces along the sides of the prisms that stand on the tiles. A piece is convex, and so
// within the distance of its farthest corner from any one tile.
class PatchDistance {
 public:
  PatchDistance(std::span<const Corners> others, std::span<const Corners> more) {
    tiles_.reserve(others.size() + more.size());
    for (const Corners& t : others) tiles_.emplace_back(t);
    for (const Corners& t : more) tiles_.emplace_back(t);
    cuts_left_ = kCutsATile * static_cast<int>(tiles_.size());
  }

  double squared() const { return squared_; }

  // No point of the patch that is bounded can be nearer than all corners are.
  void reach(const Corners& face) {
    for (const Vec3d corner : {face.a, face.b, face.c}) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Tile& tile : tiles_) nearest = std::min(nearest, tile.distance.squared(corner));
      squared_ = std::max(squared_, kTolerance * nearest);
    }
  }

  // `piece` is not over any of the tiles before `first`.
  void add(const ConvexPolygon& piece, std::size_t first) {
    if (piece.empty()) return;
    while (first < tiles_.size() && is_beside(piece, tiles_[first])) ++first;
    if (first == tiles_.size() || !piece.can_be_cut() || cuts_left_ <= 0) {
      halve(piece, kMostHalvings);
    } else {
      cut(piece, first);
    }
  }

 private:
  static constexpr int kCutsATile = 48, kMostHalvings = 2;
  static constexpr double kTolerance = 2;  // of a square

  static bool is_beside(const ConvexPolygon& piece, const Tile& tile) {
    return std::any_of(tile.sides.begin(), tile.sides.end(),
                       [&](const Plane& side) { return piece.heights(side).low >= 0; });
  }

  // What is over the first tile belongs to it, unless it is far above, and the rest to those after
  // it.
  void cut(const ConvexPolygon& piece, std::size_t first) {
    const Tile& tile = tiles_[first];
    if (squared_to(tile, piece) <= squared_) return;
    ConvexPolygon rest = piece;
    for (const Plane& side : tile.sides) {
      if (!rest.can_be_cut()) break;
      --cuts_left_;
      const auto [below, above] = rest.cut(side);
      add(above, first + 1);
      rest = below;
      if (rest.empty()) return;
    }
    if (squared_to(tile, rest) > squared_) add(rest, first + 1);
  }

  // A piece that is over no tile: what is left beyond their border.
  void halve(const ConvexPolygon& piece, int halvings_left) {
    const double squared = squared_to_best(piece);
    if (squared <= squared_) return;
    if (halvings_left == 0 || !piece.can_be_cut() || cuts_left_-- <= 0) {
      squared_ = squared;
      return;
    }
    const auto extent = piece.extent();
    const auto [below, above] = piece.cut({extent.middle(), extent.to - extent.from});
    for (const ConvexPolygon& half : {below, above}) {
      if (!half.empty()) halve(half, halvings_left - 1);
    }
  }

  static double squared_to(const Tile& tile, const ConvexPolygon& piece) {
    double farthest = 0;
    for (const Vec3d corner : piece.corners()) {
      farthest = std::max(farthest, tile.distance.squared(corner));
    }
    return farthest;
  }

  // To the one tile that is nearest to the farthest corner.
  double squared_to_best(const ConvexPolygon& piece) const {
    double best = std::numeric_limits<double>::infinity();
    for (const Tile& tile : tiles_) {
      best = std::min(best, squared_to(tile, piece));
      if (best <= squared_) break;
    }
    return best;
  }

  std::vector<Tile> tiles_;
  int cuts_left_ = 0;
  double squared_ = 0;
};

}  // namespace

double patch_distance(std::span<const Corners> faces, std::span<const Corners> others,
                      std::span<const Corners> more) {
  PatchDistance distance(others, more);
  for (const Corners& face : faces) distance.reach(face);
  for (const Corners& face : faces) distance.add(ConvexPolygon(face), 0);
  return std::sqrt(distance.squared());
}

}  // namespace pmesh
