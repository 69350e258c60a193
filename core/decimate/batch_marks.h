// What a batch has already taken, by vertex. Private to core/decimate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"

namespace pmesh {

class BatchMarks {
 public:
  explicit BatchMarks(std::uint32_t vertex_slots) : marks_(vertex_slots, 0) {}

  /// Forgets everything.
  void start_batch() { ++batch_; }

  /// Vertices around those that a step has removed or moved: no other step may move them.
  void block(std::span<const VertexId> ring) {
    for (const VertexId v : ring) marks_[v.value] = batch_;
  }
  bool is_blocked(VertexId v) const { return marks_[v.value] == batch_; }

 private:
  std::uint32_t batch_ = 0;
  std::vector<std::uint32_t> marks_;  // the last batch that has blocked the vertex
};

}  // namespace pmesh
