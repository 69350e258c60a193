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
  PatchDistance(std::span<const Corners> others, std::span<const Corners> more, double limit,
                int effort)
      : squared_limit_(limit * limit), halvings_(2 * effort) {
    tiles_.reserve(others.size() + more.size());
    for (const Corners& t : others) tiles_.emplace_back(t);
    for (const Corners& t : more) tiles_.emplace_back(t);
    cuts_left_ = effort * kCutsATile * static_cast<int>(tiles_.size());
  }

  double squared() const { return std::min(squared_, squared_limit_); }

  // No point of the patch that is bounded can be nearer than all corners are.
  void reach(const Corners& face) {
    for (const Vec3d corner : {face.a, face.b, face.c}) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Tile& tile : tiles_) {
        nearest = std::min(nearest, kTolerance * tile.distance.squared(corner));
        if (nearest <= squared_) break;
      }
      squared_ = std::max(squared_, nearest);
    }
  }

  // `piece` is not over any of the tiles before `first`.
  void add(const ConvexPolygon& piece, std::size_t first) {
    if (piece.empty() || squared_ >= squared_limit_) return;
    while (first < tiles_.size() && is_beside(piece, tiles_[first])) ++first;
    if (first == tiles_.size() || cuts_left_ <= 0) {
      halve(piece, halvings_);
    } else if (piece.can_be_cut()) {
      cut(piece, first);
    } else {
      const auto [below, above] = piece.cut_by_diagonal();
      add(below, first);
      add(above, first);
    }
  }

 private:
  static constexpr int kCutsATile = 20;
  static constexpr double kTolerance = 2;  // of a square

  static bool is_beside(const ConvexPolygon& piece, const Tile& tile) {
    return std::any_of(tile.sides.begin(), tile.sides.end(),
                       [&](const Plane& side) { return piece.heights(side).low >= 0; });
  }

  // What is over the first tile belongs to it, unless it is far above, and the rest to those after
  // it.
  void cut(const ConvexPolygon& piece, std::size_t first) {
    const Tile& tile = tiles_[first];
    if (squared_to(tile, piece, squared_) <= squared_) return;
    ConvexPolygon rest = piece;
    for (const Plane& side : tile.sides) {
      if (!rest.can_be_cut()) return add(rest, first);
      --cuts_left_;
      const auto [below, above] = rest.cut(side);
      add(above, first + 1);
      rest = below;
      if (rest.empty()) return;
    }
    if (squared_to(tile, rest, squared_) > squared_) add(rest, first + 1);
  }

  // A piece that is over no tile: what is left beyond their border.
  void halve(const ConvexPolygon& piece, int halvings_left) {
    const double squared = squared_to_best(piece);
    if (squared <= squared_) return;
    if (halvings_left == 0 || cuts_left_-- <= 0) {
      squared_ = squared;
      return;
    }
    const auto extent = piece.extent();
    const auto [below, above] = piece.can_be_cut()
                                    ? piece.cut({extent.middle(), extent.to - extent.from})
                                    : piece.cut_by_diagonal();
    if (!below.empty()) halve(below, halvings_left - 1);
    if (!above.empty()) halve(above, halvings_left - 1);
  }

  // To the farthest corner, or that of a corner that is farther than `enough`.
  static double squared_to(const Tile& tile, const ConvexPolygon& piece, double enough) {
    double farthest = 0;
    for (const Vec3d corner : piece.corners()) {
      farthest = std::max(farthest, tile.distance.squared(corner));
      if (farthest > enough) break;
    }
    return farthest;
  }

  // To the one tile that is nearest to the farthest corner.
  double squared_to_best(const ConvexPolygon& piece) {
    double best = squared_to(tiles_[last_best_], piece, squared_limit_);
    for (std::size_t i = 0; i < tiles_.size() && best > squared_; ++i) {
      const double squared = squared_to(tiles_[i], piece, best);
      if (squared >= best) continue;
      best = squared;
      last_best_ = i;
    }
    return best;
  }

  double squared_limit_;
  int halvings_;
  std::vector<Tile> tiles_;
  std::size_t last_best_ = 0;
  int cuts_left_ = 0;
  double squared_ = 0;
};

}  // namespace

double patch_distance(std::span<const Corners> faces, std::span<const Corners> others,
                      std::span<const Corners> more, double limit, int effort) {
  if (others.empty() && more.empty()) return limit;
  PatchDistance distance(others, more, limit, effort);
  for (const Corners& face : faces) distance.reach(face);
  for (const Corners& face : faces) distance.add(ConvexPolygon(face), 0);
  return std::sqrt(distance.squared());
}

}  // namespace pmesh
