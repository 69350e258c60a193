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

  void add(double squared_distance) {
    largest_squared = std::max(largest_squared, squared_distance);
    distance += std::sqrt(squared_distance);
    squared += squared_distance;
  }
  void add(const Sums& other) {
    largest_squared = std::max(largest_squared, other.largest_squared);
    distance += other.distance;
    squared += other.squared;
  }
};

// Over `count` points, by blocks, so that the threads do not show in the sums' rounding.
// visit(begin, end, look) calls look(point, hint) for the points of a block, neighbours in a row;
// the hint is a face of the target, or kNoIndex for the one found last.
template <class VisitPoints>
SurfaceDistance distance_over(std::uint32_t count, const Surface& target, unsigned threads,
                              const VisitPoints& visit) {
  constexpr std::uint32_t kBlock = 1 << 12;
  std::vector<Sums> blocks((count + kBlock - 1) / kBlock);
  for_blocks<kBlock>(count, threads, [&](std::uint32_t begin, std::uint32_t end) {
    std::uint32_t last = kNoIndex;
    Sums& sums = blocks[begin / kBlock];
    visit(begin, end, [&](Vec3d point, std::uint32_t hint) {
      const NearestFace nearest = target.nearest(point, hint == kNoIndex ? last : hint);
      last = nearest.face;
      sums.add(nearest.squared);
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
                                 const BoundMemory* memory) {
  const auto hint_for = [&](std::uint32_t face) {
    return memory == nullptr ? kNoIndex : memory->hint(source.given_face(face), target);
  };
  return distance_over(sampler.count(), target, threads,
                       [&](std::uint32_t begin, std::uint32_t end, const auto& look) {
                         sampler.visit(begin, end, [&](const SamplePoint& sample) {
                           look(sample.on(source.corners(sample.face)), hint_for(sample.face));
                         });
                       });
}

SurfaceDistance vertex_distance(const Surface& source, const Surface& target, unsigned threads) {
  const std::vector<std::uint32_t> vertices = measured_vertices(source);
  return distance_over(static_cast<std::uint32_t>(vertices.size()), target, threads,
                       [&](std::uint32_t begin, std::uint32_t end, const auto& look) {
                         for (std::uint32_t i = begin; i < end; ++i) {
                           look(source.position(vertices[i]), kNoIndex);
                         }
                       });
}

}  // namespace pmesh
