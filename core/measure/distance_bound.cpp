#include "core/measure/distance_bound.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/measure/face_bound.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {

// What one thread does in a row.
struct DistanceBound::Part {
  FaceBounder bounder;
  double bound = 0;
  std::uint32_t last_nearest = kNoIndex;  // the nearest face of the neighbour before
  std::vector<OpenFace> open;

  void note(double distance) { bound = std::max(bound, distance); }
};

void DistanceBound::sweep() {
  constexpr std::uint32_t kPartLevel = 4;  // a part is a node with up to 1024 faces
  const std::uint32_t level = std::min(kPartLevel, source_.tree().level_count() - 1);
  const std::uint32_t count = source_.tree().node_count(level);
  std::vector<Part> parts(count, Part{FaceBounder(target_, tolerance_, reached_), 0, kNoIndex, {}});
  for_blocks<1>(count, threads_,
                [&](std::uint32_t node, std::uint32_t) { sweep_node(level, node, parts[node]); });
  take(parts);
}

void DistanceBound::take(const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    reach(part.bounder.reached());
    bound_ = std::max(bound_, part.bound);
    open_.insert(open_.end(), part.open.begin(), part.open.end());
  }
}

void DistanceBound::sweep_node(std::uint32_t level, std::uint32_t node, Part& part) const {
  const Box<float> box = source_.tree().box(level, node);
  const Vec3d low{box.low.x, box.low.y, box.low.z}, high{box.high.x, box.high.y, box.high.z};
  const double radius = length(high - low) / 2;
  if (level > 0 && radius < part.bounder.good_enough()) {
    const NearestFace nearest = target_.nearest(0.5 * (low + high), part.last_nearest);
    part.last_nearest = nearest.face;
    const double farthest = std::sqrt(nearest.squared) + radius;
    if (farthest <= part.bounder.good_enough()) return part.note(farthest);
  }
  const std::uint32_t begin = FaceTree::kWidth * node;
  const std::uint32_t children =
      level > 0 ? source_.tree().node_count(level - 1) : source_.face_count();
  for (std::uint32_t c = begin; c < std::min(begin + FaceTree::kWidth, children); ++c) {
    if (level > 0) {
      sweep_node(level - 1, c, part);
    } else {
      sweep_face(c, part);
    }
  }
}

void DistanceBound::sweep_face(std::uint32_t face, Part& part) const {
  const Corners t = source_.corners(face);
  if (is_collapsed(t)) return;
  FaceBounder& bounder = part.bounder;
  if (memory_ != nullptr) {
    const std::optional<double> known = memory_->recall(source_.given_face(face));
    if (known && *known <= bounder.good_enough()) return part.note(*known);
  }
  const std::array<Vec3d, 3> corners = {t.a, t.b, t.c};
  const std::uint32_t hint = hint_for(face, part);
  if (hint != kNoIndex) {
    const double distance = bounder.distance_to_face(corners, hint);
    if (distance <= bounder.good_enough()) {
      part.last_nearest = hint;
      keep(face, distance, hint);
      return part.note(distance);
    }
  }
  const NearestFace nearest = target_.nearest((1.0 / 3) * (t.a + t.b + t.c), hint);
  part.last_nearest = nearest.face;
  bounder.reach(std::sqrt(nearest.squared));
  const double distance = bounder.distance_to_face(corners, nearest.face);
  if (distance > bounder.good_enough()) {
    bounder.reach_corners(corners, nearest.face);
    return part.open.push_back({face, nearest.face});
  }
  keep(face, distance, nearest.face);
  part.note(distance);
}

std::uint32_t DistanceBound::hint_for(std::uint32_t face, const Part& part) const {
  if (memory_ == nullptr) return part.last_nearest;
  const std::uint32_t hint = memory_->hint(source_.given_face(face));
  return hint < target_.face_count() ? target_.face_given_as(hint) : part.last_nearest;
}

void DistanceBound::keep(std::uint32_t face, double distance, std::uint32_t witness) const {
  if (memory_ == nullptr) return;
  Witnesses witnesses;
  witnesses.add(target_.given_face(witness));
  memory_->keep(source_.given_face(face), distance, witnesses);
}

void DistanceBound::refine() {
  constexpr std::uint32_t kRound = 1 << 14, kPart = 1 << 5;
  const std::vector<OpenFace> open = std::move(open_);
  open_.clear();
  // What one round reaches spares the next one work.
  for (std::size_t done = 0; done < open.size(); done += kRound) {
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(kRound, open.size() - done));
    std::vector<Part> parts((count + kPart - 1) / kPart,
                            Part{FaceBounder(target_, tolerance_, reached_), 0, kNoIndex, {}});
    for_blocks<kPart>(count, threads_, [&](std::uint32_t begin, std::uint32_t end) {
      Part& part = parts[begin / kPart];
      for (std::uint32_t i = begin; i < end; ++i) {
        const auto [face, hint] = open[done + i];
        const FaceBounder::Bound bound = part.bounder.bound(source_.corners(face), hint);
        part.note(bound.distance);
        if (memory_ != nullptr) {
          memory_->keep(source_.given_face(face), bound.distance, bound.witnesses);
        }
      }
    });
    take(parts);
  }
}

}  // namespace pmesh
