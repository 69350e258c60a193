#include "core/pm/patch.h"

#include <algorithm>

namespace pmesh {
namespace {

constexpr int kFractionBits = 3;  // local coordinates are in eighths
constexpr int kWeightBits = 5;    // weights are in 1/32

// Rounded to the nearest integer, halves up. Preconditions: 0 < b < 2^10, and the coordinates are
// below 2^16 b. (One unsigned division each: the quotient is shifted to where it is positive.)
Vec3l divide_small(Int4 a, std::uint32_t b) {
  constexpr std::uint32_t kShift = 1 << 17;
  const auto one = [b](std::int32_t of) {
    const std::uint32_t twice = 2 * static_cast<std::uint32_t>(of) + b;
    return std::int64_t{(twice + 2 * b * kShift) / (2 * b)} - kShift;
  };
  return {one(a[0]), one(a[1]), one(a[2])};
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
  const Vec3l offset = widen(int4(point) - int4(kept));
  return clamp_to(shift_right(8 * offset, shift), kLocalReach);
}

void Patch::gather(const RefinableMesh& mesh, const Fan& fan) {
  kind = fan.kind();
  faces = fan.faces();
  kept = mesh.positions()[fan.kept().value];
  opposite_count_ = 0;
  if (faces == 0) {
    gather_ear(mesh, fan.half_edges()[0]);
  } else {
    gather_fan(mesh, fan);
  }
  measure_polygon();
  measure_opposites();
  measure_normal();
  measure_area_centre();
  measure_spread();
}

// The polygon, and what lies across the fan's outer edges, still on the lattice. A border_last fan
// is walked clockwise.
void Patch::gather_fan(const RefinableMesh& mesh, const Fan& fan) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const Vec3i* const positions = mesh.positions().data();
  const Int4 origin = int4(kept);
  const auto look_across = [&](HalfEdgeId outer, std::uint32_t edge) {
    const HalfEdgeId across = connectivity.twin(outer);
    if (!across.valid()) return;
    outer_edges_[opposite_count_] = static_cast<std::uint16_t>(edge);
    opposites_[opposite_count_++] = int4(positions[connectivity.apex(across).value]) - origin;
  };
  const bool clockwise = kind == SplitKind::border_last;
  const std::span<const HalfEdgeId> half_edges = fan.half_edges();
  const HalfEdgeId first = half_edges.front(), last = half_edges.back();
  const VertexId begin = clockwise ? connectivity.apex(first) : connectivity.target(first);
  outline_[1] = int4(positions[begin.value]) - origin;
  if (kind == SplitKind::interior) look_across(first, 0);
  for (std::uint32_t face = 0; face < faces; ++face) {
    const HalfEdgeId h = half_edges[face];
    const VertexId end = clockwise ? connectivity.target(h) : connectivity.apex(h);
    outline_[face + 2] = int4(positions[end.value]) - origin;
    look_across(HalfEdgeMesh::next(h), face + 1);
  }
  look_across(clockwise ? last : HalfEdgeMesh::prev(last), faces + 1);
}

// An ear's patch is the face that it is glued to, seen from across the border half-edge.
void Patch::gather_ear(const RefinableMesh& mesh, HalfEdgeId glued_to) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const std::span<const Vec3i> positions = mesh.positions();
  const Int4 origin = int4(kept);
  const bool leaves_kept = kind == SplitKind::border_first;
  const VertexId other =
      leaves_kept ? connectivity.target(glued_to) : connectivity.origin(glued_to);
  outline_[1] = int4(positions[other.value]) - origin;
  outer_edges_[opposite_count_] = 0;
  opposites_[opposite_count_++] = int4(positions[connectivity.apex(glued_to).value]) - origin;
}

void Patch::measure_polygon() {
  const std::span<Int4> corners = std::span(outline_).subspan(1, faces + 1);
  Int4 reach{};
  for (const Int4& corner : corners) reach |= magnitude(corner);
  shift = std::max(0, bit_length(reach[0] | reach[1] | reach[2]) + kFractionBits - kLocalBits);
  const int left = std::max(0, kFractionBits - shift), right = std::max(0, shift - kFractionBits);
  Int4 sum{};
  for (Int4& corner : corners) sum += corner = (corner << left) >> right;
  outline_[0] = outline_[faces + 2] = Int4{};
  sum_ = sum;
  centroid = divide_small(sum, faces + 2);
  features[0] = Vec3l{} - centroid;
  const Int4 middle = (corners.front() + corners.back() + 1) >> 1;
  features[1] = widen(middle) - centroid;
}

// Clamped to kLocalBits before they are shifted, which is the same as after it, but cannot
// overflow.
void Patch::measure_opposites() {
  const int left = std::max(0, kFractionBits - shift), right = std::max(0, shift - kFractionBits);
  const std::int32_t most = (1 << kLocalBits) << right >> left;
  Int4 sum{};
  for (std::uint32_t i = 0; i < opposite_count_; ++i) {
    const std::uint32_t edge = outer_edges_[i];
    const Int4 corner = (clamp_to(opposites_[i], most) << left) >> right;
    sum += opposites_[i] = outline_[edge] + outline_[edge + 1] - corner;
  }
  opposite_mean_ = opposite_count_ == 0 ? centroid : divide_small(sum, opposite_count_);
  features[2] = opposite_mean_ - centroid;
}

void Patch::measure_normal() {
  Vec3l sum{};
  area = 0;
  for (std::uint32_t i = 0; i < faces; ++i) {
    const Int4 &a = outline_[i + 1], &b = outline_[i + 2];
    const Vec3i product = cross(Vec3i{a[0], a[1], a[2]}, Vec3i{b[0], b[1], b[2]});
    crosses[i] = product;
    sum += Vec3l{product.x, product.y, product.z};
    area += manhattan(product);
  }
  if (faces == 0) {
    const Vec3l end = widen(outline_[1]);
    sum = cross(end, widen(opposites_[0]) - end);
  }
  normal = shift_right(sum, std::max(0, bit_length(largest(sum)) - kLocalBits));
  if (normal == Vec3l{}) normal = {0, 0, 1};
  normal_squared = dot(normal, normal);
  normal_length = square_root(normal_squared);
}

void Patch::measure_area_centre() {
  features[3] = {};
  if (area == 0) return;
  const int drop = std::max(0, bit_length(area) - 20);
  Vec3l moments{};
  std::int64_t weights = 0;
  for (std::uint32_t i = 0; i < faces; ++i) {
    const std::int64_t weight = manhattan(crosses[i]) >> drop;
    const Int4 sides = outline_[i + 1] + outline_[i + 2];
    moments += weight * widen(sides);
    weights += weight;
  }
  if (weights > 0) features[3] = divide(moments, 3 * weights) - centroid;
}

// Squares about the centroid are made from those about kept.
void Patch::measure_spread() {
  const std::int64_t count = faces + 2;
  const Vec3l up = normal;
  const std::int64_t centre_height = dot(centroid, up);
  std::int64_t squares = 0, off = std::abs(centre_height);
  for (const Int4& corner : polygon()) {
    const Vec3l at = widen(corner);
    squares += dot(at, at);
    off += std::abs(dot(at, up) - centre_height);
  }
  squares += count * dot(centroid, centroid) - 2 * dot(sum_, centroid);
  radius_squared = squares / count;
  flatness = off / (count * normal_length);
  const std::int64_t mean_height = dot(opposite_mean_, up);
  std::int64_t opposite_off = 0;
  for (std::uint32_t i = 0; i < opposite_count_; ++i) {
    opposite_off += std::abs(dot(opposites_[i], up) - mean_height);
  }
  opposite_flatness = opposite_count_ == 0 ? 0 : opposite_off / (opposite_count_ * normal_length);
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
      distance_to_plane(patch, prediction.at - patch.centroid) / patch.normal_length;
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
  const std::int64_t rise = distance_to_plane(patch, back) / patch.normal_length;
  prediction.normal_class = magnitude_class(rise * rise, patch.shift);
  return prediction;
}

int split_cost(const Patch& patch, Vec3i added) {
  const Vec3l at = clamp_to(patch.local(added), std::int64_t{1} << kLocalBits);
  std::int64_t volume = 0;
  for (std::uint32_t i = 0; i < patch.faces; ++i) {
    const Vec3i& product = patch.crosses[i];
    volume += std::abs(at.x * product.x + at.y * product.y + at.z * product.z);
  }
  int cost = 2 * half_octaves(volume) - half_octaves(patch.area);
  if (patch.kind != SplitKind::interior) {  // what the border sweeps
    cost = std::max(cost, 2 * half_octaves(manhattan(cross(at, widen(patch.polygon()[0])))));
  }
  return cost + 8 * patch.shift;
}

}  // namespace pmesh
