// What is known of the faces of one surface by the other, carried from one level of detail to the
// next: as long as neither a face nor the faces that its bound rests on have changed, it need not
// be bounded again; and what was near it is a good place to begin.
//
// Faces go by their numbers in the meshes given, which persist from level to level.
//
// Threads: different faces may be recalled and kept at the same time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/measure/surface.h"

namespace pmesh {

/// The faces of the other surface that a bound rests on: those nearest to the pieces of the face.
class Witnesses {
 public:
  void add(std::uint32_t face) {
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (faces_[i] == face) return;
    }
    if (count_ < kMost) {
      faces_[count_++] = face;
    } else {
      complete_ = false;
    }
  }
  /// False if there were too many to be noted.
  bool complete() const { return complete_; }
  std::span<const std::uint32_t> faces() const { return {faces_.data(), count_}; }

 private:
  static constexpr std::uint32_t kMost = 4;
  std::array<std::uint32_t, kMost> faces_{};
  std::uint8_t count_ = 0;
  bool complete_ = true;
};

/// By face, the last level at which it was new or changed; nothing for a surface that never does.
using ChangeLevels = std::span<const std::uint32_t>;

class BoundMemory {
 public:
  /// From now on a level has `faces` faces, and bounds are kept as of `level`, which only grows.
  void begin_level(std::uint32_t level, std::size_t faces, ChangeLevels source_changes,
                   ChangeLevels target_changes) {
    level_ = level;
    source_changes_ = source_changes;
    target_changes_ = target_changes;
    bounds_.resize(faces);
  }

  /// The bound kept for a face, if it still holds.
  std::optional<double> recall(std::uint32_t face) const {
    const Bound& bound = bounds_[face];
    if (bound.level == 0 || is_newer(source_changes_, face, bound.level)) return std::nullopt;
    for (const std::uint32_t witness : bound.witnesses.faces()) {
      if (is_newer(target_changes_, witness, bound.level)) return std::nullopt;
    }
    return bound.witnesses.complete() ? std::optional<double>(bound.distance) : std::nullopt;
  }

  /// A face of the other surface that was near, by its place in `target`; or kNoIndex.
  std::uint32_t hint(std::uint32_t face, const Surface& target) const {
    const auto witnesses = bounds_[face].witnesses.faces();
    if (witnesses.empty() || witnesses.front() >= target.face_count()) return kNoIndex;
    return target.face_given_as(witnesses.front());
  }

  void keep(std::uint32_t face, double distance, const Witnesses& witnesses) {
    bounds_[face] = {level_, distance, witnesses};
  }

 private:
  struct Bound {
    std::uint32_t level = 0;
    double distance = 0;
    Witnesses witnesses;
  };
  static bool is_newer(ChangeLevels changes, std::uint32_t face, std::uint32_t level) {
    return !changes.empty() && changes[face] > level;
  }

  std::uint32_t level_ = 0;
  ChangeLevels source_changes_, target_changes_;
  std::vector<Bound> bounds_;
};

}  // namespace pmesh
