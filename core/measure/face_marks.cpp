#include "core/measure/face_marks.h"

#include <algorithm>

namespace pmesh {
namespace {

bool meet(const Box<float>& a, const Box<double>& b) {
  return a.low.x <= b.high.x && a.low.y <= b.high.y && a.low.z <= b.high.z && a.high.x >= b.low.x &&
         a.high.y >= b.low.y && a.high.z >= b.low.z;
}

bool is_within(const Box<float>& a, const Box<double>& b) {
  return a.low.x >= b.low.x && a.low.y >= b.low.y && a.low.z >= b.low.z && a.high.x <= b.high.x &&
         a.high.y <= b.high.y && a.high.z <= b.high.z;
}

}  // namespace

FaceMarks::FaceMarks(const FaceTree& tree)
    : tree_(tree), faces_(FaceTree::kWidth * std::size_t{tree.node_count(0)}, false) {
  for (std::uint32_t level = 0; level < tree.level_count(); ++level) {
    below_.emplace_back(tree.node_count(level), Below::none);
  }
}

void FaceMarks::mark(std::uint32_t face) {
  faces_[face] = true;
  std::uint32_t node = face;
  for (std::vector<Below>& level : below_) {
    node /= FaceTree::kWidth;
    level[node] = std::max(level[node], Below::some);
  }
}

// Whether all faces below one of the nodes above this one are marked.
bool FaceMarks::all_above(std::uint32_t level, std::uint32_t node) const {
  while (++level < tree_.level_count()) {
    node /= FaceTree::kWidth;
    if (below_[level][node] == Below::all) return true;
  }
  return false;
}

void FaceMarks::mark_near(const Box<double>& box, std::uint32_t level, std::uint32_t node) {
  Below& below = below_[level][node];
  if (below == Below::all || !meet(tree_.box(level, node), box)) return;
  if (is_within(tree_.box(level, node), box)) {
    below = Below::all;
    return;
  }
  below = Below::some;
  const std::uint32_t first = FaceTree::kWidth * node;
  for (std::uint32_t k = 0; k < FaceTree::kWidth; ++k) {
    if (!meet(tree_.child_box(level, node, k), box)) continue;
    if (level > 0) {
      mark_near(box, level - 1, first + k);
    } else {
      faces_[first + k] = true;
    }
  }
}

}  // namespace pmesh
