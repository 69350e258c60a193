// Some of a surface's faces, marked in its tree of boxes: so that a walk down the tree finds them
// without looking at the others.
#pragma once

#include <cstdint>
#include <vector>

#include "core/measure/face_tree.h"

namespace pmesh {

/// Threads: const members may be called at the same time.
class FaceMarks {
 public:
  /// None is marked. `tree` must outlive the object.
  explicit FaceMarks(const FaceTree& tree);

  void mark(std::uint32_t face);
  /// Marks all faces whose boxes meet `box`. In time proportional to the nodes at its border.
  void mark_near(const Box<double>& box) { mark_near(box, tree_.level_count() - 1, 0); }
  bool any() const { return below_.back()[0] != Below::none; }

  enum class Below : std::uint8_t { none, some, all };
  /// Of the faces below a node. Where all are, or all below a node above, nothing further down
  /// counts.
  Below below(std::uint32_t level, std::uint32_t node) const { return below_[level][node]; }
  bool all_above(std::uint32_t level, std::uint32_t node) const;
  bool is_marked(std::uint32_t face) const { return faces_[face]; }

 private:
  void mark_near(const Box<double>& box, std::uint32_t level, std::uint32_t node);

  const FaceTree& tree_;
  std::vector<std::vector<Below>> below_;  // by level and node
  std::vector<bool> faces_;
};

}  // namespace pmesh
