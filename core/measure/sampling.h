// Points spread over a surface: where the distance is looked at.
//
// Each sample is a function of seed and number alone, so that any thread may draw any of them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/measure/surface.h"

namespace pmesh {

/// A point of a face: (1 - u - v) a + u b + v c.
struct SamplePoint {
  std::uint32_t face = 0;
  double u = 0, v = 0;

  Vec3d on(const Corners& t) const { return t.a + u * (t.b - t.a) + v * (t.c - t.a); }
};

/// `count` points over the faces, or over their edges, of a surface. The total of the faces'
/// weights (area; perimeter; either times a density) is cut into `count` equal strata along the
/// spatial order of the faces, with a random point in each: a uniform density, or the one given,
/// and neighbours one after another.
class SurfaceSampler {
 public:
  enum class Over : std::uint8_t { faces, edges };

  /// Collapsed faces get no sample. `density`, by face, is empty or all above 0. `surface` must
  /// outlive the sampler.
  SurfaceSampler(const Surface& surface, Over over, std::uint32_t count, std::uint64_t seed,
                 std::vector<double> density = {});

  /// Samples to be had: none if no face has a weight.
  std::uint32_t count() const { return total() > 0 ? count_ : 0; }

  /// What a sample on `face` counts, if the mean is to be that over the surface: 1 if the density
  /// is uniform.
  double weight(std::uint32_t face) const {
    return density_.empty() ? 1 : mean_density_ / density_[face];
  }

  /// Calls visit(point) for the samples begin .. end - 1 in order. end <= count().
  template <class Visit>
  void visit(std::uint32_t begin, std::uint32_t end, const Visit& visit) const {
    std::uint32_t face = begin < end ? face_at(stratum(begin)) : 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const double at = stratum(i);
      while (face + 1 < surface_.face_count() && weight_up_to_[face] <= at) ++face;
      visit(point_in(face, i));
    }
  }

 private:
  double total() const { return weight_up_to_.back(); }
  double stratum(std::uint32_t i) const;  // a random place in the i-th, as weight before it
  std::uint32_t face_at(double weight) const;
  SamplePoint point_in(std::uint32_t face, std::uint32_t i) const;
  double random(std::uint32_t i, std::uint32_t draw) const;  // [0, 1)

  const Surface& surface_;
  Over over_;
  std::uint32_t count_;
  std::uint64_t seed_;
  std::vector<double> density_;  // by face, or empty
  double mean_density_ = 1;
  std::vector<double> weight_up_to_;  // by face: its weight and that of all before
};

/// The vertices of the faces that are not collapsed, each once, in the faces' order.
std::vector<std::uint32_t> measured_vertices(const Surface& surface);

}  // namespace pmesh
