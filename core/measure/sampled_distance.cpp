#include "core/measure/sampled_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

// Distances summed up.
struct Sums {
  double largest_squared = 0, distance = 0, squared = 0;

  void add(double squared_distance, double weight) {
    largest_squared = std::max(largest_squared, squared_distance);
    distance += weight * std::sqrt(squared_distance);
    squared += weight * squared_distance;
  }
  void add(const Sums& other) {
    largest_squared = std::max(largest_squared, other.largest_squared);
    distance += other.distance;
    squared += other.squared;
  }
};

// Over `count` points, by blocks, so that the threads do not show in the sums' rounding.
// visit(begin, end, look) calls look(point, weight) for the points of a block, neighbours in a row.
// `near` as in sampled_distance().
template <class VisitPoints>
SurfaceDistance distance_over(std::uint32_t count, const Surface& target, unsigned threads,
                              std::vector<std::uint32_t>* near, const VisitPoints& visit) {
  constexpr std::uint32_t kBlock = 1 << 10;
  std::vector<Sums> blocks((count + kBlock - 1) / kBlock);
  for_blocks<kBlock>(count, threads, [&](std::uint32_t begin, std::uint32_t end) {
    std::uint32_t last = kNoIndex, i = begin;
    Sums& sums = blocks[begin / kBlock];
    visit(begin, end, [&](Vec3d point, double weight) {
      const bool is_known = near != nullptr && (*near)[i] != kNoIndex;
      const NearestFace nearest = target.nearest(point, is_known ? (*near)[i] : last);
      last = nearest.face;
      if (near != nullptr) (*near)[i] = nearest.face;
      ++i;
      sums.add(nearest.squared, weight);
    });
  });
  Sums total;
  for (const Sums& block : blocks) total.add(block);
  if (count == 0) return {};
  return {std::sqrt(total.largest_squared), total.distance / count,
          std::sqrt(total.squared / count)};
}

}  // namespace

SurfaceDistance sampled_distance(const Surface& source, const SurfaceSampler& sampler,
                                 const Surface& target, unsigned threads,
                                 std::vector<std::uint32_t>* near) {
  return distance_over(sampler.count(), target, threads, near,
                       [&](std::uint32_t begin, std::uint32_t end, const auto& look) {
                         sampler.visit(begin, end, [&](const SamplePoint& sample) {
                           look(sample.on(source.corners(sample.face)),
                                sampler.weight(sample.face));
                         });
                       });
}

SurfaceDistance vertex_distance(const Surface& source, const Surface& target, unsigned threads) {
  const std::vector<std::uint32_t> vertices = measured_vertices(source);
  return distance_over(static_cast<std::uint32_t>(vertices.size()), target, threads, nullptr,
                       [&](std::uint32_t begin, std::uint32_t end, const auto& look) {
                         for (std::uint32_t i = begin; i < end; ++i) {
                           look(source.position(vertices[i]), 1);
                         }
                       });
}

}  // namespace pmesh
