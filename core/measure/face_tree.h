// A packed tree of boxes over faces in spatial order: four boxes a node, children found by index.
// Boxes are in single precision, rounded outwards: 32 bytes a face.
//
// Threads: const members may be called at the same time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/box.h"
#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace pmesh {

struct NearestFace {
  double squared = std::numeric_limits<double>::infinity();  ///< Squared distance.
  std::uint32_t face = kNoIndex;
};

class FaceTree {
 public:
  FaceTree() = default;
  /// Over faces with these boxes, in unit coordinates (core/measure/surface.h). Not empty.
  explicit FaceTree(const std::vector<Box<float>>& boxes);

  /// The nearest of `start` and all faces, as `squared_distance(face)` says, to `p`. That function
  /// is called for few faces: those whose boxes are as near as the best so far.
  template <class SquaredDistance>
  NearestFace nearest(Vec3d p, NearestFace start, const SquaredDistance& squared_distance) const {
    return nearest_below(level_count() - 1, 0, p, start, squared_distance);
  }
  /// The same among the faces around start.face in the order, 64 or so: what is near is there more
  /// often than not.
  template <class SquaredDistance>
  NearestFace near(Vec3d p, NearestFace start, const SquaredDistance& squared_distance) const {
    const std::uint32_t level = std::min(2u, level_count() - 1);
    return nearest_below(level, start.face >> (2 * level + 2), p, start, squared_distance);
  }

  /// Node n of level l holds the children 4 n .. 4 n + 3: nodes of level l - 1, or faces if l is 0.
  /// The last level has one node.
  static constexpr std::uint32_t kWidth = 4;
  std::uint32_t level_count() const { return static_cast<std::uint32_t>(levels_.size()); }
  std::uint32_t node_count(std::uint32_t level) const {
    return static_cast<std::uint32_t>(levels_[level].size());
  }
  /// Around all below a node.
  Box<float> box(std::uint32_t level, std::uint32_t node) const;
  /// Around its child k < kWidth; empty (low above high) if it has none.
  Box<float> child_box(std::uint32_t level, std::uint32_t node, std::uint32_t k) const {
    const Node& n = levels_[level][node];
    return {{n.low[0][k], n.low[1][k], n.low[2][k]}, {n.high[0][k], n.high[1][k], n.high[2][k]}};
  }

 private:
  // Four numbers that are added, multiplied and compared at once (an extension of GCC and Clang).
  using Lanes __attribute__((vector_size(kWidth * sizeof(float)))) = float;
  using Point = std::array<Lanes, 3>;  // each coordinate in all lanes
  struct Node {
    std::array<Lanes, 3> low, high;
  };
  struct Visit {
    float squared;  // distance to the node's box
    std::uint32_t level, node;
  };

  template <class SquaredDistance>
  NearestFace nearest_below(std::uint32_t level, std::uint32_t node, Vec3d p, NearestFace start,
                            const SquaredDistance& squared_distance) const;
  static Lanes squared_distances(const Node& node, const Point& p);
  static float cull_radius(double squared);

  std::vector<std::vector<Node>> levels_;  // [0]: a box a face; the last: the root
};

inline FaceTree::Lanes FaceTree::squared_distances(const Node& node, const Point& p) {
  const Lanes zero{};
  Lanes sum{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Lanes below = node.low[axis] - p[axis], above = p[axis] - node.high[axis];
    const Lanes outside = below > above ? below : above;
    const Lanes off = outside > zero ? outside : zero;
    sum += off * off;
  }
  return sum;
}

// The squared distance beyond which a box cannot hold anything nearer, whatever single precision
// has rounded: `p` by 2^-25 of its size, the sum of squares by 2^-22 of itself.
inline float FaceTree::cull_radius(double squared) {
  constexpr double kRounding = 2e-7, kRelative = 1 + 1e-6;
  const double radius = std::sqrt(squared) + kRounding;
  return static_cast<float>(kRelative * radius * radius);
}

template <class SquaredDistance>
NearestFace FaceTree::nearest_below(std::uint32_t level, std::uint32_t node, Vec3d p,
                                    NearestFace start,
                                    const SquaredDistance& squared_distance) const {
  constexpr std::size_t kMaxLevels = 16;
  const Point point = {Lanes{} + static_cast<float>(p.x), Lanes{} + static_cast<float>(p.y),
                       Lanes{} + static_cast<float>(p.z)};
  NearestFace best = start;
  float cull = cull_radius(best.squared);
  std::array<Visit, 3 * kMaxLevels + 1> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, level, node};
  while (depth > 0) {
    const Visit visit = stack[--depth];
    if (visit.squared > cull) continue;
    const Lanes squared = squared_distances(levels_[visit.level][visit.node], point);
    const std::size_t floor = depth;
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      if (!(squared[k] < cull)) continue;  // an empty lane is infinitely far
      const std::uint32_t child = kWidth * visit.node + k;
      if (visit.level == 0) {
        if (const double d = squared_distance(child); d < best.squared) {
          best = {d, child};
          cull = cull_radius(d);
        }
        continue;
      }
      std::size_t at = depth++;  // the nearest on top
      for (; at > floor && stack[at - 1].squared < squared[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {squared[k], visit.level - 1, child};
    }
  }
  return best;
}

}  // namespace pmesh
