// The steps of all batches, and their order in the log. Private to core/decimate.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/decimate/working_mesh.h"
#include "core/parallel/workers.h"

namespace pmesh {

class BatchLog {
 public:
  /// `most`: a guess at how many steps there will be.
  explicit BatchLog(std::size_t most) { steps_.reserve(most); }

  /// The next step has been logged in `work`. Steps of equal keys go by `tie`.
  void add(float key, std::uint32_t tie) { steps_.push_back({key, tie, count()}); }

  /// False if the batch is empty.
  bool end_batch(WorkingMesh& work) {
    if (count() == first_of(ends_.size())) return false;
    ends_.push_back(count());
    work.end_batch();
    return true;
  }

  /// Puts every batch's steps into ascending order of their keys.
  void sort(WorkingMesh& work, std::uint32_t collapses_per_step, Workers& workers) {
    const auto batches = static_cast<std::uint32_t>(ends_.size());
    for_blocks<1>(batches, workers, [&](std::uint32_t batch, std::uint32_t, std::uint32_t) {
      const std::uint32_t first = first_of(batch);
      std::sort(steps_.begin() + first, steps_.begin() + ends_[batch]);
      std::vector<std::uint32_t> order;
      for (std::uint32_t i = first; i < ends_[batch]; ++i) order.push_back(steps_[i].place - first);
      work.reorder_batch(first, order, collapses_per_step);
    });
  }

 private:
  struct Step {
    float key;
    std::uint32_t tie;
    std::uint32_t place;  // in the log, in steps
    friend bool operator<(const Step& a, const Step& b) {
      return a.key < b.key || (a.key == b.key && a.tie < b.tie);
    }
  };

  std::uint32_t count() const { return static_cast<std::uint32_t>(steps_.size()); }
  std::uint32_t first_of(std::size_t batch) const { return batch == 0 ? 0 : ends_[batch - 1]; }

  std::vector<Step> steps_;
  std::vector<std::uint32_t> ends_;  // by batch, in steps
};

}  // namespace pmesh
