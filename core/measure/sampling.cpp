#include "core/measure/sampling.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pmesh {
namespace {

// SplitMix64: Steele, Lea and Flood, Fast splittable pseudorandom number generators (2014).
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9E37'79B9'7F4A'7C15u;
  z = (z ^ (z >> 30)) * 0xBF58'476D'1CE4'E5B9u;
  z = (z ^ (z >> 27)) * 0x94D0'49BB'1331'11EBu;
  return z ^ (z >> 31);
}

double area(const Corners& t) { return length(cross(t.b - t.a, t.c - t.a)) / 2; }

double perimeter(const Corners& t) {
  return length(t.b - t.a) + length(t.c - t.b) + length(t.a - t.c);
}

// The point of the outline of `t` at `fraction` of its length.
SamplePoint point_on_outline(std::uint32_t face, const Corners& t, double fraction) {
  const double ab = length(t.b - t.a), bc = length(t.c - t.b), ca = length(t.a - t.c);
  double along = fraction * (ab + bc + ca);
  if (along < ab) return {face, along / ab, 0};
  along -= ab;
  if (along < bc) return {face, 1 - along / bc, along / bc};
  along = std::min(along - bc, ca);
  return {face, 0, 1 - along / ca};
}

}  // namespace

SurfaceSampler::SurfaceSampler(const Surface& surface, Over over, std::uint32_t count,
                               std::uint64_t seed, std::vector<double> density)
    : surface_(surface),
      over_(over),
      count_(count),
      seed_(mixed(seed)),
      density_(std::move(density)) {
  weight_up_to_.reserve(surface.face_count());
  double sum = 0, size = 0;
  for (std::uint32_t face = 0; face < surface.face_count(); ++face) {
    const Corners t = surface.corners(face);
    if (!is_collapsed(t)) {
      const double of_face = over == Over::faces ? area(t) : perimeter(t);
      size += of_face;
      sum += density_.empty() ? of_face : density_[face] * of_face;
    }
    weight_up_to_.push_back(sum);
  }
  if (size > 0) mean_density_ = sum / size;
}

double SurfaceSampler::random(std::uint32_t i, std::uint32_t draw) const {
  const std::uint64_t counter = std::uint64_t{4} * i + draw;
  return std::ldexp(static_cast<double>(mixed(seed_ ^ counter) >> 11), -53);
}

double SurfaceSampler::stratum(std::uint32_t i) const {
  return (i + random(i, 0)) / count_ * total();
}

std::uint32_t SurfaceSampler::face_at(double weight) const {
  const auto found = std::upper_bound(weight_up_to_.begin(), weight_up_to_.end(), weight);
  return static_cast<std::uint32_t>(
      std::min<std::ptrdiff_t>(found - weight_up_to_.begin(), surface_.face_count() - 1));
}

SamplePoint SurfaceSampler::point_in(std::uint32_t face, std::uint32_t i) const {
  if (over_ == Over::edges) return point_on_outline(face, surface_.corners(face), random(i, 1));
  const double root = std::sqrt(random(i, 1)), share = random(i, 2);
  return {face, root * (1 - share), root * share};
}

std::vector<std::uint32_t> measured_vertices(const Surface& surface) {
  std::vector<bool> is_seen(surface.vertex_count(), false);
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t face = 0; face < surface.face_count(); ++face) {
    if (is_collapsed(surface.corners(face))) continue;
    for (const std::uint32_t vertex : surface.triangle(face)) {
      if (is_seen[vertex]) continue;
      is_seen[vertex] = true;
      vertices.push_back(vertex);
    }
  }
  return vertices;
}

}  // namespace pmesh
