#include "core/measure/face_tree.h"

#include <algorithm>
#include <cassert>

namespace pmesh {

FaceTree::FaceTree(const std::vector<Box<float>>& boxes) {
  assert(!boxes.empty());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr Lanes kNowhereLow = {kInfinity, kInfinity, kInfinity, kInfinity};
  constexpr Lanes kNowhereHigh = {-kInfinity, -kInfinity, -kInfinity, -kInfinity};
  constexpr Node kEmpty = {{kNowhereLow, kNowhereLow, kNowhereLow},
                           {kNowhereHigh, kNowhereHigh, kNowhereHigh}};

  const auto set_lane = [](Node& node, std::size_t lane, const Box<float>& bounds) {
    const std::array<float, 3> low = {bounds.low.x, bounds.low.y, bounds.low.z};
    const std::array<float, 3> high = {bounds.high.x, bounds.high.y, bounds.high.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.low[axis][lane] = low[axis];
      node.high[axis][lane] = high[axis];
    }
  };
  const auto nodes_for = [](std::size_t children) { return (children + kWidth - 1) / kWidth; };

  levels_.emplace_back(nodes_for(boxes.size()), kEmpty);
  for (std::size_t face = 0; face < boxes.size(); ++face) {
    set_lane(levels_[0][face / kWidth], face % kWidth, boxes[face]);
  }
  while (levels_.back().size() > 1) {
    const std::vector<Node>& children = levels_.back();
    std::vector<Node> parents(nodes_for(children.size()), kEmpty);
    for (std::uint32_t c = 0; c < children.size(); ++c) {
      const Box<float> hull = box(level_count() - 1, c);
      set_lane(parents[c / kWidth], c % kWidth, hull);
    }
    levels_.push_back(std::move(parents));
  }
}

Box<float> FaceTree::box(std::uint32_t level, std::uint32_t node) const {
  const Node& n = levels_[level][node];
  const auto least = [](const Lanes& lanes) {
    return std::min({lanes[0], lanes[1], lanes[2], lanes[3]});
  };
  const auto most = [](const Lanes& lanes) {
    return std::max({lanes[0], lanes[1], lanes[2], lanes[3]});
  };
  return {{least(n.low[0]), least(n.low[1]), least(n.low[2])},
          {most(n.high[0]), most(n.high[1]), most(n.high[2])}};
}

}  // namespace pmesh
