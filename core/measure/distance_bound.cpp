#include "core/measure/distance_bound.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/measure/face_bound.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

// Of one face: what is tried at first, and the bounded effort that ends every refinement.
constexpr std::uint32_t kFewCuts = 24, kManyCuts = 20'000;

}  // namespace

// What one thread does in a row.
struct DistanceBound::Part {
  FaceBounder bounder;
  double bound = 0;
  std::vector<OpenFace> open;
  std::uint32_t near_node = kNoIndex;  // the face nearest to the last node looked at

  void note(double distance) { bound = std::max(bound, distance); }
};

void DistanceBound::sweep() {
  constexpr std::uint32_t kPartLevel = 4;  // a part is a node with up to 1024 faces
  const std::uint32_t level = std::min(kPartLevel, source_.tree().level_count() - 1);
  const std::uint32_t count = source_.tree().node_count(level);
  std::vector<Part> parts(count, Part{FaceBounder(target_, tolerance_, reached_), 0, {}, kNoIndex});
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
    const NearestFace nearest = target_.nearest(0.5 * (low + high), part.near_node);
    part.near_node = nearest.face;
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
  if (!bound_face(face, hint_for(face, bounder), kFewCuts, part)) {
    part.open.push_back({face, bounder.last_near()});
  }
}

bool DistanceBound::bound_face(std::uint32_t face, std::uint32_t hint, std::uint32_t most_cuts,
                               Part& part) const {
  const FaceBounder::Bound bound = part.bounder.bound(source_.corners(face), hint, most_cuts);
  const bool is_good = bound.distance <= part.bounder.good_enough();
  if (is_good || most_cuts == kManyCuts) part.note(bound.distance);
  if (is_good && memory_ != nullptr) {
    memory_->keep(source_.given_face(face), bound.distance, bound.witnesses);
  }
  return is_good;
}

std::uint32_t DistanceBound::hint_for(std::uint32_t face, const FaceBounder& bounder) const {
  if (memory_ == nullptr) return bounder.last_near();
  const std::uint32_t hint = memory_->hint(source_.given_face(face), target_);
  return hint == kNoIndex ? bounder.last_near() : hint;
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
                            Part{FaceBounder(target_, tolerance_, reached_), 0, {}, kNoIndex});
    for_blocks<kPart>(count, threads_, [&](std::uint32_t begin, std::uint32_t end) {
      Part& part = parts[begin / kPart];
      for (std::uint32_t i = begin; i < end; ++i) {
        const auto [face, hint] = open[done + i];
        bound_face(face, hint, kManyCuts, part);
      }
    });
    take(parts);
  }
}

}  // namespace pmesh
