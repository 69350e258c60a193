#include "core/measure/distance_bound.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

// Of one face: what is tried at first, and the bounded effort that ends every refinement.
constexpr std::uint32_t kFewCuts = 24, kManyCuts = 20'000;

using Below = FaceMarks::Below;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

// What one thread does in a row.
struct DistanceBound::Part {
  FaceBounder bounder;
  const BoundRecord& record;
  double bound = 0;
  std::vector<OpenFace> open = {};
  std::vector<FaceDistance> of_source = {}, of_target = {};
  std::uint32_t near_node = 0;  // the face nearest to the last node looked at

  // No point of the faces begin .. end - 1 is farther than this from one of the `near` faces.
  void note(std::uint32_t begin, std::uint32_t end, double distance,
            std::span<const FaceDistance> near) {
    bound = std::max(bound, distance);
    if (record.of_target != nullptr) of_target.insert(of_target.end(), near.begin(), near.end());
    if (record.of_source == nullptr) return;
    for (std::uint32_t face = begin; face < end; ++face) of_source.push_back({face, distance});
  }
};

std::vector<DistanceBound::Part> DistanceBound::parts(std::size_t count) const {
  return std::vector<Part>(count, Part{FaceBounder(target_, tolerance_, reached_), record_});
}

void DistanceBound::take(const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    if (part.bounder.reached() > reached_) {
      reached_ = part.bounder.reached();
      farthest_ = part.bounder.farthest();
    }
    bound_ = std::max(bound_, part.bound);
    append(open_, part.open);
    if (record_.of_source != nullptr) append(*record_.of_source, part.of_source);
    if (record_.of_target != nullptr) append(*record_.of_target, part.of_target);
  }
}

// Bounds all faces for which little work suffices.
void DistanceBound::sweep() {
  constexpr std::uint32_t kPartLevel = 4;  // a part is a node with up to 1024 faces
  const std::uint32_t level = std::min(kPartLevel, source_.tree().level_count() - 1);
  const std::uint32_t count = source_.tree().node_count(level);
  std::vector<Part> parts = this->parts(count);
  for_blocks<1>(count, threads_, [&](std::uint32_t node, std::uint32_t) {
    const bool all_marked = marks_ == nullptr || marks_->all_above(level, node);
    sweep_node(level, node, all_marked, parts[node]);
  });
  take(parts);
}

void DistanceBound::sweep_node(std::uint32_t level, std::uint32_t node, bool all_marked,
                               Part& part) const {
  if (!all_marked) {
    const Below below = marks_->below(level, node);
    if (below == Below::none) return;
    all_marked = below == Below::all;
  }
  if (level > 0 && all_marked && bound_node(level, node, part)) return;
  const std::uint32_t begin = FaceTree::kWidth * node;
  const std::uint32_t children =
      level > 0 ? source_.tree().node_count(level - 1) : source_.face_count();
  for (std::uint32_t c = begin; c < std::min(begin + FaceTree::kWidth, children); ++c) {
    if (level > 0) {
      sweep_node(level - 1, c, all_marked, part);
    } else if (all_marked || marks_->is_marked(c)) {
      sweep_face(c, part);
    }
  }
}

// All faces of a node at once: by the middle of its box and a face that is near enough to it.
bool DistanceBound::bound_node(std::uint32_t level, std::uint32_t node, Part& part) const {
  const Box<float> box = source_.tree().box(level, node);
  const Vec3d low{box.low.x, box.low.y, box.low.z}, high{box.high.x, box.high.y, box.high.z};
  const Vec3d middle = 0.5 * (low + high);
  const double radius = length(high - low) / 2;
  if (radius >= part.bounder.good_enough()) return false;
  const auto is_good = [&](const NearestFace& face) {
    part.near_node = face.face;
    const double farthest = std::sqrt(face.squared) + radius;
    if (farthest > part.bounder.good_enough()) return false;
    const std::uint32_t shift = 2 * level + 2;
    const FaceDistance near{face.face, farthest};
    part.note(node << shift, std::min((node + 1) << shift, source_.face_count()), farthest,
              {&near, 1});
    return true;
  };
  return is_good({target_.squared_distance(middle, part.near_node), part.near_node}) ||
         is_good(target_.near(middle, part.near_node)) ||
         is_good(target_.nearest(middle, part.near_node));
}

void DistanceBound::sweep_face(std::uint32_t face, Part& part) const {
  if (is_collapsed(source_.corners(face))) return;
  if (!bound_face(face, part.bounder.last_near(), kFewCuts, part)) {
    part.open.push_back({face, part.bounder.last_near()});
  }
}

bool DistanceBound::bound_face(std::uint32_t face, std::uint32_t hint, std::uint32_t most_cuts,
                               Part& part) const {
  const double bound = part.bounder.bound(source_.corners(face), hint, most_cuts);
  const bool is_good = bound <= part.bounder.good_enough();
  if (is_good || most_cuts == kManyCuts) {
    part.note(face, face + 1, bound, part.bounder.near_faces());
  }
  return is_good;
}

// Bounds the rest.
void DistanceBound::refine() {
  constexpr std::uint32_t kRound = 1 << 14, kPart = 1 << 5;
  const std::vector<OpenFace> open = std::move(open_);
  open_.clear();
  // What one round reaches spares the next one work.
  for (std::size_t done = 0; done < open.size(); done += kRound) {
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(kRound, open.size() - done));
    std::vector<Part> parts = this->parts((count + kPart - 1) / kPart);
    for_blocks<kPart>(count, threads_, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        const auto [face, hint] = open[done + i];
        bound_face(face, hint, kManyCuts, parts[begin / kPart]);
      }
    });
    take(parts);
  }
}

}  // namespace pmesh
