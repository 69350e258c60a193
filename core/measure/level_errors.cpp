#include "core/measure/level_errors.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "core/measure/distance_bound.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kSeed = 0;

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

// Rounding in unit coordinates: what compare_surfaces() may find above the bound.
constexpr double kRounding = 4e-15;

std::uint32_t samples_for(MeshView original, const LevelErrorOptions& options) {
  if (options.samples != 0) return options.samples;
  return original.triangles.size() < 200'000 ? 1 << 17 : 1 << 13;
}

// More samples where the bounds are large: there errors are rare and count much. By face of `lod`.
std::vector<double> sampling_density(const Surface& lod, const std::vector<double>& bounds,
                                     unsigned threads) {
  double squares = 0;
  for (const double bound : bounds) squares += bound * bound;
  if (!(squares > 0) || !std::isfinite(squares)) return {};
  const double scale = static_cast<double>(bounds.size()) / squares;
  std::vector<double> density(lod.face_count());
  for_each_index(density.size(), threads, [&](std::uint32_t face) {
    const double bound = bounds[lod.given_face(face)];
    density[face] = 1 + scale * bound * bound;
  });
  return density;
}

// Around all points within `distance` of a triangle.
Box<double> box_around(const Corners& t, double distance) {
  const std::array<Vec3d, 3> corners = {t.a, t.b, t.c};
  const Box<double> box = bounding_box(std::span<const Vec3d>(corners));
  const Vec3d margin{distance, distance, distance};
  return {box.low - margin, box.high + margin};
}

}  // namespace

// One LOD and what is known of it.
class LevelErrors::Level {
 public:
  Level(const Surface& original, const Surface& lod, FaceErrors& known, FarPoints& far,
        unsigned threads)
      : original_(original), lod_(lod), known_(known), far_(far), threads_(threads) {}

  // Tightens all bounds to within the tolerance above the largest distance reached.
  void tighten(double reached) {
    reached_ = reached;
    look_at_far_points();
    tighten_to_original();
    tighten_from_original();
  }

  double bound() const {
    double bound = 0;
    for (std::uint32_t given = 0; given < known_.size(); ++given) {
      bound = std::max(bound, known_.from_original[given]);
      if (known_.to_original[given] > bound && counts(given)) bound = known_.to_original[given];
    }
    return bound;
  }

 private:
  bool is_good(double bound) const {
    return bound <= std::max((1 + kErrorTolerance) * reached_, kNoDistance);
  }

  // Distances are not measured from collapsed faces.
  bool counts(std::uint32_t given) const {
    return !is_collapsed(lod_.corners(lod_.face_given_as(given)));
  }

  // The faces whose bounds are not good, by the numbers given.
  std::vector<std::uint32_t> open_faces(const std::vector<double>& bounds) const {
    std::vector<std::uint32_t> open;
    for (std::uint32_t given = 0; given < bounds.size(); ++given) {
      if (!is_good(bounds[given])) open.push_back(given);
    }
    return open;
  }

  void look_at_far_points() {
    for (const Vec3d point : far_.of_original) {
      reached_ = std::max(reached_, std::sqrt(lod_.nearest(point, kNoIndex).squared));
    }
    std::vector<std::uint32_t> faces;
    for (const Vec3d point : far_.of_lods) {
      faces.push_back(lod_.given_face(lod_.nearest(point, kNoIndex).face));
    }
    tighten_to_original(faces);
  }

  // The worst first: the sooner a large distance is reached, the fewer bounds have to be tightened.
  void tighten_to_original() {
    for (const std::size_t most : {std::size_t{1} << 8, std::size_t{1} << 11, kNoLimit}) {
      std::vector<std::uint32_t> open = open_faces(known_.to_original);
      const bool is_last = open.size() <= most;
      if (!is_last) keep_worst(open, most);
      tighten_to_original(open);
      if (is_last) return;
    }
  }

  void keep_worst(std::vector<std::uint32_t>& open, std::size_t most) const {
    const std::vector<double>& bounds = known_.to_original;
    std::nth_element(open.begin(), open.begin() + static_cast<std::ptrdiff_t>(most), open.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       return bounds[a] != bounds[b] ? bounds[a] > bounds[b] : a < b;
                     });
    open.resize(most);
  }

  void tighten_to_original(std::span<const std::uint32_t> open) {
    FaceMarks marks(lod_.tree());
    for (const std::uint32_t given : open) marks.mark(lod_.face_given_as(given));
    std::vector<FaceDistance> proven;
    find(lod_, original_, marks, {.of_source = &proven}, far_.of_lods);
    for (const FaceDistance& found : proven) {
      double& bound = known_.to_original[lod_.given_face(found.face)];
      bound = std::min(bound, found.distance);
    }
  }

  // Faces to which points too far away are charged give all of them up, and these are charged to
  // faces that are proven to be near.
  void tighten_from_original() {
    std::vector<double>& bounds = known_.from_original;
    FaceMarks open(original_.tree());
    for (const std::uint32_t given : open_faces(bounds)) {
      open.mark_near(box_around(lod_.corners(lod_.face_given_as(given)), bounds[given]));
      bounds[given] = 0;
    }
    std::vector<FaceDistance> proven;
    find(original_, lod_, open, {.of_target = &proven}, far_.of_original);
    for (const FaceDistance& found : proven) {
      double& bound = bounds[lod_.given_face(found.face)];
      bound = std::max(bound, found.distance);
    }
  }

  // Adds the farthest point to `far`, if it is farther than all that was known.
  void find(const Surface& source, const Surface& target, const FaceMarks& open,
            const BoundRecord& record, std::vector<Vec3d>& far) {
    if (!open.any()) return;
    DistanceBound distance(source, target, kErrorTolerance, threads_, &open, record);
    distance.reach(reached_);
    distance.find();
    reached_ = distance.reached();
    if (distance.farthest()) far.push_back(*distance.farthest());
  }

  const Surface& original_;
  const Surface& lod_;
  FaceErrors& known_;
  FarPoints& far_;
  unsigned threads_;
  double reached_ = 0;
};

LevelErrors::LevelErrors(MeshView original, const UnitFrame& frame,
                         const LevelErrorOptions& options)
    : frame_(frame),
      options_(options),
      original_(std::make_unique<Surface>(original, frame, options.threads)),
      samples_(*original_, SurfaceSampler::Over::faces, samples_for(original, options), kSeed) {
  options_.samples = samples_.count();
}

// In the order of the LOD before, if that one had all its faces and vertices.
Surface LevelErrors::surface_of(MeshView lod) {
  const std::size_t faces = lod.triangles.size(), vertices = lod.positions.size();
  std::erase_if(order_.faces, [&](std::uint32_t face) { return face >= faces; });
  std::erase_if(order_.vertices, [&](std::uint32_t vertex) { return vertex >= vertices; });
  if (order_.faces.size() < faces || order_.vertices.size() < vertices) {
    order_ = spatial_order_of(lod, frame_, options_.threads);
  }
  return Surface(lod, frame_, options_.threads, order_);
}

SurfaceDistance LevelErrors::sample_original(const Surface& lod) {
  std::vector<std::uint32_t>& near = near_samples_;
  near.resize(samples_.count(), kNoIndex);
  for (std::uint32_t& face : near) {
    face = face < lod.face_count() ? lod.face_given_as(face) : kNoIndex;
  }
  const SurfaceDistance distance =
      sampled_distance(*original_, samples_, lod, options_.threads, &near);
  for (std::uint32_t& face : near) face = lod.given_face(face);
  return distance;
}

LevelError LevelErrors::measure(MeshView lod, FaceErrors& known) {
  assert(known.size() == lod.triangles.size());
  const unsigned threads = options_.threads;
  const Surface surface = surface_of(lod);
  const SurfaceSampler samples(surface, SurfaceSampler::Over::faces, options_.samples, kSeed,
                               sampling_density(surface, known.to_original, threads));
  const SurfaceDistance forward = sample_original(surface);
  const SurfaceDistance backward = sampled_distance(surface, samples, *original_, threads);

  Level level(*original_, surface, known, far_, threads);
  level.tighten(std::max(forward.max, backward.max));
  const double bound = level.bound();
  if (bound <= kNoDistance) return {};
  return {frame_.to_length(bound + kRounding),
          frame_.to_length(std::max(forward.rms, backward.rms))};
}

}  // namespace pmesh
