#include "core/measure/level_errors.h"

#include <algorithm>

#include "core/measure/distance_bound.h"
#include "core/measure/sampled_distance.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kSeed = 0;

// Rounding in unit coordinates: what compare_surfaces() may find above the bound.
constexpr double kRounding = 4e-15;

}  // namespace

Result<LevelErrors> LevelErrors::of(MeshView original, const LevelErrorOptions& options) {
  const Result<UnitFrame> frame = unit_frame(box_of_faces(original));
  if (!frame) return frame.error();
  LevelErrorOptions chosen = options;
  if (chosen.samples == 0) chosen.samples = original.triangles.size() < 200'000 ? 1 << 17 : 1 << 14;
  return LevelErrors(original, *frame, chosen);
}

LevelErrors::LevelErrors(MeshView original, const UnitFrame& frame,
                         const LevelErrorOptions& options)
    : frame_(frame),
      options_(options),
      original_(std::make_unique<Surface>(original, frame, options.threads)),
      samples_(*original_, SurfaceSampler::Over::faces, options.samples, kSeed) {}

LevelError LevelErrors::measure(MeshView lod) {
  note_changes(lod);
  const Surface surface(lod, frame_, options_.threads);
  forward_.begin_level(level_, original_->face_count(), {}, changed_at_);
  backward_.begin_level(level_, surface.face_count(), changed_at_, {});
  const SurfaceSampler lod_samples(surface, SurfaceSampler::Over::faces, options_.samples, kSeed);
  const SurfaceDistance forward =
      sampled_distance(*original_, samples_, surface, options_.threads, &forward_);
  const SurfaceDistance backward =
      sampled_distance(surface, lod_samples, *original_, options_.threads, &backward_);

  const double bound = bound_of_maximum(surface, std::max(forward.max, backward.max));
  if (bound <= kNoDistance) return {};
  return {frame_.to_length(bound + kRounding),
          frame_.to_length(std::max(forward.rms, backward.rms))};
}

// Marks the faces that are not as they were at the level before.
void LevelErrors::note_changes(MeshView lod) {
  ++level_;
  const auto corner = [](MeshView mesh, std::size_t face, std::size_t k) {
    return mesh.positions[mesh.triangles[face][k]];
  };
  const MeshView before{previous_.positions, previous_.triangles};
  const std::size_t in_both = std::min(before.triangles.size(), lod.triangles.size());
  changed_at_.resize(std::max(changed_at_.size(), lod.triangles.size()), 0);
  for (std::size_t face = 0; face < changed_at_.size(); ++face) {
    bool is_same = face < in_both;
    for (std::size_t k = 0; is_same && k < 3; ++k) {
      is_same = corner(before, face, k) == corner(lod, face, k);
    }
    if (!is_same) changed_at_[face] = level_;
  }
  previous_.positions.assign(lod.positions.begin(), lod.positions.end());
  previous_.triangles.assign(lod.triangles.begin(), lod.triangles.end());
}

// Both directions: nothing in the LOD or the original is farther from the other.
double LevelErrors::bound_of_maximum(const Surface& lod, double reached) {
  DistanceBound forward(*original_, lod, kErrorTolerance, options_.threads, &forward_);
  DistanceBound backward(lod, *original_, kErrorTolerance, options_.threads, &backward_);
  forward.reach(reached);
  forward.sweep();
  backward.reach(forward.reached());
  backward.sweep();
  forward.reach(backward.reached());
  forward.refine();
  backward.reach(forward.reached());
  backward.refine();
  return std::max(forward.bound(), backward.bound());
}

}  // namespace pmesh
