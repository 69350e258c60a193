#include "core/pm/components.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "core/base/box.h"

namespace pmesh {
namespace {

// By vertex of the decimated mesh, one vertex of its component: the one with the smallest id of
// those that stand in the base.
class Roots {
 public:
  Roots(const LiveMesh& live, const CollapseLog& log, std::size_t vertices) : parents_(vertices) {
    std::iota(parents_.begin(), parents_.end(), 0u);
    for (const auto& [a, b, c] : live.triangles) {
      join(live.vertices[a].value, live.vertices[b].value);
      join(live.vertices[a].value, live.vertices[c].value);
    }
    for (std::size_t i = log.collapses.size(); i-- > 0;) {
      const HalfEdgeCollapse& collapse = log.collapses[i];
      parents_[collapse.removed.value] = find(collapse.kept.value);
    }
    for (std::uint32_t v = 0; v < vertices; ++v) parents_[v] = find(v);
  }

  std::uint32_t of(VertexId v) const { return parents_[v.value]; }

 private:
  std::uint32_t find(std::uint32_t v) {
    while (parents_[v] != v) v = parents_[v] = parents_[parents_[v]];
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

  std::vector<std::uint32_t> parents_;
};

// By root, the squared diagonal of the component's box.
std::vector<std::uint64_t> squared_sizes(const Roots& roots, std::span<const Vec3i> positions) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  std::vector<Box<std::int32_t>> boxes(positions.size(), {{kMost, kMost, kMost}, {}});
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    const Vec3i p = positions[v];
    auto& [low, high] = boxes[roots.of(VertexId(v))];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  std::vector<std::uint64_t> sizes;
  for (const auto& [low, high] : boxes) {
    const auto squared = [](std::int64_t side) { return static_cast<std::uint64_t>(side * side); };
    sizes.push_back(squared(high.x - low.x) + squared(high.y - low.y) + squared(high.z - low.z));
  }
  return sizes;
}

// The roots in the order in which their components come. Multiples of the golden ratio spread those
// of a size evenly over the ids, and so, as meshes go, over space.
std::vector<std::uint32_t> sorted_by_size(const Roots& roots, std::span<const Vec3i> positions) {
  const std::vector<std::uint64_t> sizes = squared_sizes(roots, positions);
  struct Entry {
    std::uint64_t size;
    std::uint32_t spread, root;
  };
  std::vector<Entry> entries;
  for (std::uint32_t v = 0; v < positions.size(); ++v) {
    if (roots.of(VertexId(v)) != v) continue;
    entries.push_back({sizes[v], static_cast<std::uint32_t>(entries.size()) * 0x9E37'79B9u, v});
  }
  const auto largest =
      std::max_element(entries.begin(), entries.end(),
                       [](const Entry& a, const Entry& b) { return a.size < b.size; });
  std::swap(*largest, entries.front());
  std::sort(entries.begin() + 1, entries.end(), [](const Entry& a, const Entry& b) {
    const auto size_a = std::bit_width(a.size), size_b = std::bit_width(b.size);
    return size_a != size_b ? size_a > size_b : a.spread < b.spread;
  });
  std::vector<std::uint32_t> sorted;
  sorted.reserve(entries.size());
  for (const Entry& entry : entries) sorted.push_back(entry.root);
  return sorted;
}

// 0 to count - 1, those of one component together. Fills in where each component's begin.
template <class ComponentOf, class SetStart>
std::vector<std::uint32_t> grouped(std::size_t count, std::size_t components,
                                   ComponentOf component_of, SetStart set_start) {
  std::vector<std::size_t> starts(components + 1);
  for (std::uint32_t i = 0; i < count; ++i) ++starts[component_of(i) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  for (std::size_t c = 0; c <= components; ++c) set_start(c, starts[c]);
  std::vector<std::uint32_t> items(count);
  for (std::uint32_t i = 0; i < count; ++i) items[starts[component_of(i)]++] = i;
  return items;
}

std::vector<std::uint32_t> sorted_range(const std::vector<std::uint32_t>& items, std::size_t first,
                                        std::size_t end) {
  std::vector<std::uint32_t> range(items.begin() + static_cast<std::ptrdiff_t>(first),
                                   items.begin() + static_cast<std::ptrdiff_t>(end));
  std::sort(range.begin(), range.end());
  return range;
}

}  // namespace

Components::Components(const HalfEdgeMesh& base, std::span<const Vec3i> positions,
                       const CollapseLog& log)
    : positions_(positions), live_(base.live()) {
  const Roots roots(live_, log, positions.size());
  const std::vector<std::uint32_t> sorted = sorted_by_size(roots, positions);
  std::vector<std::uint32_t> ranks(positions.size());
  for (std::uint32_t c = 0; c < sorted.size(); ++c) ranks[sorted[c]] = c;
  const auto component = [&](VertexId v) { return ranks[roots.of(v)]; };

  starts_.resize(sorted.size() + 1);
  vertices_ = grouped(
      live_.vertices.size(), sorted.size(), [&](auto i) { return component(live_.vertices[i]); },
      [&](std::size_t c, std::size_t start) { starts_[c].vertex = start; });
  triangles_ = grouped(
      live_.triangles.size(), sorted.size(),
      [&](auto i) { return component(live_.vertices[live_.triangles[i][0]]); },
      [&](std::size_t c, std::size_t start) { starts_[c].triangle = start; });
  collapses_ = grouped(
      log.collapses.size(), sorted.size(), [&](auto i) { return component(log.collapses[i].kept); },
      [&](std::size_t c, std::size_t start) { starts_[c].collapse = start; });
}

Components::Part Components::part(std::size_t first, std::size_t end) const {
  Part part;
  const auto vertices = sorted_range(vertices_, starts_[first].vertex, starts_[end].vertex);
  for (const std::uint32_t v : vertices) {
    part.originals.push_back(live_.vertices[v]);
    part.mesh.positions.push_back(positions_[live_.vertices[v].value]);
  }
  for (const std::uint32_t t :
       sorted_range(triangles_, starts_[first].triangle, starts_[end].triangle)) {
    Triangle triangle = live_.triangles[t];
    for (std::uint32_t& v : triangle) {
      const auto place = std::lower_bound(vertices.begin(), vertices.end(), v);
      v = static_cast<std::uint32_t>(place - vertices.begin());
    }
    part.mesh.triangles.push_back(triangle);
  }
  return part;
}

std::vector<std::uint32_t> Components::collapses(std::size_t first, std::size_t end) const {
  return sorted_range(collapses_, starts_[first].collapse, starts_[end].collapse);
}

}  // namespace pmesh
