#include "core/pm/patch.h"

#include <algorithm>

namespace pmesh {
namespace {

constexpr int kFractionBits = 3;  // local coordinates are in eighths
constexpr int kWeightBits = 5;    // weights are in 1/32

Vec3l widen(Vec3i a) { return {a.x, a.y, a.z}; }

// At most 2^(kLocalBits - 1) off the polygon's own size, so products of two fit 32 bits.
Vec3i scaled(Vec3l difference, int shift) {
  const Vec3l local = shift_right(8 * difference, shift);
  return {static_cast<std::int32_t>(local.x), static_cast<std::int32_t>(local.y),
          static_cast<std::int32_t>(local.z)};
}

Vec3l scale_to(const std::array<std::int64_t, 2>& weights, Vec3l kept, Vec3l opposite) {
  return weights[0] * kept + weights[1] * opposite;
}

int magnitude_class(std::int64_t squared, int shift) {
  return std::min(63, bit_length(squared) + 2 * shift);
}

// centroid + tangential/32, its part along the normal replaced by that of normal/32.
Vec3l combine(const Patch& patch, Vec3l tangential, Vec3l normal) {
  const std::int64_t along =
      divide(dot(normal - tangential, patch.normal) * 256, patch.normal_squared);
  return patch.centroid + divide(256 * tangential + along * patch.normal, 256 << kWeightBits);
}

std::int64_t distance_to_plane(const Patch& patch, Vec3l offset) {
  return std::abs(dot(offset, patch.normal));
}

}  // namespace

std::size_t Patch::fan_class() const {
  if (kind != SplitKind::interior) return kBorderFans;
  return std::clamp<std::size_t>(faces, 2, 5) - 2;
}

Vec3l Patch::local(Vec3i point) const {
  return clamp_to(shift_right(8 * (widen(point) - widen(kept)), shift), kLocalReach);
}

void Patch::gather(const RefinableMesh& mesh, const SplitSite& site) {
  kind = site.kind;
  faces = site.moved_faces;
  opposite_count_ = 0;
  kept = mesh.positions()[kept_vertex(mesh.connectivity(), site).value];
  if (faces == 0) {
    gather_ear(mesh, site);
  } else {
    gather_fan(mesh, site);
  }
  measure();
}

// Walks the fan and what lies across its outer edges. A border_last fan is walked clockwise.
void Patch::gather_fan(const RefinableMesh& mesh, const SplitSite& site) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const std::span<const Vec3i> positions = mesh.positions();
  const bool clockwise = kind == SplitKind::border_last;
  HalfEdgeId h = clockwise ? connectivity.next(site.half_edge) : site.half_edge;
  const VertexId first = clockwise ? connectivity.apex(h) : connectivity.target(h);
  polygon[0] = positions[first.value];
  if (kind == SplitKind::interior) add_opposite(mesh, h);
  for (std::uint32_t face = 0; face < faces; ++face) {
    const VertexId other = clockwise ? connectivity.target(h) : connectivity.apex(h);
    polygon[face + 1] = positions[other.value];
    add_opposite(mesh, connectivity.next(h));
    if (face + 1 == faces) {
      add_opposite(mesh, clockwise ? h : connectivity.prev(h));
    } else {
      h = clockwise ? connectivity.rotate_cw(h) : connectivity.rotate_ccw(h);
    }
  }
}

// An ear's patch is the face that it is glued to, seen from across the border half-edge.
void Patch::gather_ear(const RefinableMesh& mesh, const SplitSite& site) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const std::span<const Vec3i> positions = mesh.positions();
  const HalfEdgeId h = site.half_edge;
  const bool leaves_kept = kind == SplitKind::border_first;
  const VertexId other = leaves_kept ? connectivity.target(h) : connectivity.origin(h);
  polygon[0] = positions[other.value];
  const Vec3i apex = positions[connectivity.apex(h).value];
  opposites_[opposite_count_++] = polygon[0] - (apex - kept);
  crosses[0] = {};
}

// The fourth corner of the parallelogram over the face across `outer`, if there is one.
void Patch::add_opposite(const RefinableMesh& mesh, HalfEdgeId outer) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const HalfEdgeId across = connectivity.twin(outer);
  if (!across.valid()) return;
  const std::span<const Vec3i> positions = mesh.positions();
  const Vec3i a = positions[connectivity.origin(outer).value];
  const Vec3i b = positions[connectivity.target(outer).value];
  opposites_[opposite_count_++] = a + (b - positions[connectivity.apex(across).value]);
}

void Patch::measure() {
  const std::uint32_t corners = faces + 1;
  std::int64_t reach = 0;
  for (std::uint32_t i = 0; i < corners; ++i) {
    reach = std::max(reach, largest(widen(polygon[i]) - widen(kept)));
  }
  shift = std::max(0, bit_length(reach) + kFractionBits - kLocalBits);

  Vec3l sum{}, opposite_sum{};
  for (std::uint32_t i = 0; i < corners; ++i) {
    polygon[i] = scaled(widen(polygon[i]) - widen(kept), shift);
    sum += widen(polygon[i]);
  }
  for (std::uint32_t i = 0; i < opposite_count_; ++i) {
    const Vec3l at = local(opposites_[i]);
    opposites_[i] = {static_cast<std::int32_t>(at.x), static_cast<std::int32_t>(at.y),
                     static_cast<std::int32_t>(at.z)};
    opposite_sum += at;
  }
  centroid = divide(sum, corners + 1);
  const Vec3l opposite_mean =
      opposite_count_ == 0 ? centroid : divide(opposite_sum, opposite_count_);
  measure_normal();
  features[0] = Vec3l{} - centroid;
  features[1] = divide(widen(polygon[0]) + widen(polygon[faces]), 2) - centroid;
  features[2] = opposite_mean - centroid;
  measure_area_centre();

  const std::int64_t normal_length = square_root(normal_squared);
  std::int64_t squares = dot(centroid, centroid), off = distance_to_plane(*this, centroid);
  for (std::uint32_t i = 0; i < corners; ++i) {
    const Vec3l offset = widen(polygon[i]) - centroid;
    squares += dot(offset, offset);
    off += distance_to_plane(*this, offset);
  }
  radius_squared = squares / (corners + 1);
  flatness = off / ((corners + 1) * normal_length);
  std::int64_t opposite_off = 0;
  for (std::uint32_t i = 0; i < opposite_count_; ++i) {
    opposite_off += distance_to_plane(*this, widen(opposites_[i]) - opposite_mean);
  }
  opposite_flatness = opposite_count_ == 0 ? 0 : opposite_off / (opposite_count_ * normal_length);
}

void Patch::measure_normal() {
  Vec3l sum{};
  area = 0;
  for (std::uint32_t i = 0; i < faces; ++i) {
    crosses[i] = cross(polygon[i], polygon[i + 1]);
    sum += widen(crosses[i]);
    area += manhattan(widen(crosses[i]));
  }
  if (faces == 0 && opposite_count_ > 0) {
    sum = cross(widen(polygon[0]), widen(opposites_[0]) - widen(polygon[0]));
  }
  normal = shift_right(sum, std::max(0, bit_length(largest(sum)) - kLocalBits));
  if (normal == Vec3l{}) normal = {0, 0, 1};
  normal_squared = dot(normal, normal);
}

void Patch::measure_area_centre() {
  features[3] = {};
  if (area == 0) return;
  const int drop = std::max(0, bit_length(area) - 20);
  Vec3l moments{};
  std::int64_t weights = 0;
  for (std::uint32_t i = 0; i < faces; ++i) {
    const std::int64_t weight = manhattan(widen(crosses[i])) >> drop;
    moments += weight * (widen(polygon[i]) + widen(polygon[i + 1]));
    weights += weight;
  }
  if (weights > 0) features[3] = divide(moments, 3 * weights) - centroid;
}

Prediction predict(const Patch& patch, const Predictor& predictor) {
  const Predictor::Weights& weights = predictor.fans[patch.fan_class()];
  Vec3l tangential{};
  for (std::size_t i = 0; i < patch.features.size(); ++i) {
    tangential += weights.tangential[i] * patch.features[i];
  }
  const Vec3l normal = scale_to(weights.normal, patch.features[0], patch.features[2]);
  Prediction prediction;
  prediction.at = combine(patch, tangential, normal);
  const std::int64_t rise =
      distance_to_plane(patch, prediction.at - patch.centroid) / square_root(patch.normal_squared);
  const std::int64_t spread = (5 * patch.flatness + 8 * rise + 6 * patch.opposite_flatness) / 16 +
                              square_root(patch.radius_squared) / 64;
  prediction.tangential_class = magnitude_class(patch.radius_squared, patch.shift);
  prediction.normal_class = magnitude_class(spread * spread, patch.shift);
  return prediction;
}

Prediction predict_kept(const Patch& patch, const Predictor& predictor, Vec3i added) {
  const Vec3l back = Vec3l{} - patch.local(added);
  Prediction prediction;
  const Vec3l tangential = predictor.mirrored[0] * back, normal = predictor.mirrored[1] * back;
  prediction.at = combine(patch, tangential, normal) - patch.centroid;
  prediction.tangential_class = magnitude_class(dot(back, back), patch.shift);
  const std::int64_t rise = distance_to_plane(patch, back) / square_root(patch.normal_squared);
  prediction.normal_class = magnitude_class(rise * rise, patch.shift);
  return prediction;
}

int split_cost(const Patch& patch, Vec3i added) {
  const Vec3l at = clamp_to(patch.local(added), std::int64_t{1} << kLocalBits);
  std::int64_t volume = 0;
  for (std::uint32_t i = 0; i < patch.faces; ++i) {
    volume += std::abs(dot(at, widen(patch.crosses[i])));
  }
  int cost = 2 * half_octaves(volume) - half_octaves(patch.area);
  if (patch.kind != SplitKind::interior) {  // what the border sweeps
    cost = std::max(cost, 2 * half_octaves(manhattan(cross(at, widen(patch.polygon[0])))));
  }
  return cost + 8 * patch.shift;
}

}  // namespace pmesh
