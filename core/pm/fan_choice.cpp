#include "core/pm/fan_choice.h"

#include <algorithm>

namespace pmesh {
namespace {

// Spokes are measured in eighths, shifted right so far that they fit this many bits.
constexpr int kSpokeBits = 14;

}  // namespace

bool VertexRing::gather(const RefinableMesh& mesh, VertexId v) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  centre_ = v;
  faces_ = 0;
  const HalfEdgeId first = connectivity.outgoing(v);
  border_ = connectivity.is_border(first);
  HalfEdgeId h = first;
  do {
    if (faces_ == kMost) return false;
    half_edges_[faces_++] = h;
    mesh.prefetch(connectivity.target(h));  // for the ranking
    const HalfEdgeId across = connectivity.twin(HalfEdgeMesh::next(h));
    if (across.valid()) connectivity.prefetch_corners(across);  // for the patch
    h = connectivity.rotate_ccw(h);
  } while (h.valid() && h != first);
  if (!border_) {
    const auto end = half_edges_.begin() + faces_;
    std::rotate(half_edges_.begin(), std::min_element(half_edges_.begin(), end), end);
  }
  return true;
}

std::uint32_t VertexRing::find_runs(const std::vector<std::uint8_t>& covered) {
  const std::uint32_t longest = border_ ? faces_ : faces_ - 1;
  std::array<std::uint8_t, kMost> free;
  for (std::uint32_t i = 0; i < faces_; ++i) free[i] = covered[face(i).value] == 0;
  std::uint32_t run = 0, most = 0;
  if (!border_) {  // a run may go over the ring's start
    for (std::uint32_t i = faces_; i-- > 0;) run = free[i] != 0 ? run + 1 : 0;
  }
  for (std::uint32_t i = faces_; i-- > 0;) {
    run = free[i] != 0 ? run + 1 : 0;
    run_[i] = static_cast<std::uint8_t>(std::min(run, longest));
    most = std::max<std::uint32_t>(most, run_[i]);
  }
  return most;
}

void VertexRing::measure_spokes(const RefinableMesh& mesh) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const std::span<const Vec3i> positions = mesh.positions();
  const Vec3i centre = positions[centre_.value];
  const std::uint32_t spokes = border_ ? faces_ + 1 : faces_;
  std::array<Spoke, kMost + 1> spoke;
  Spoke reach{};
  for (std::uint32_t i = 0; i < spokes; ++i) {
    const VertexId end =
        i < faces_ ? connectivity.target(half_edges_[i]) : connectivity.apex(half_edges_[i - 1]);
    const Vec3i p = positions[end.value] - centre;
    spoke[i] = Spoke{p.x, p.y, p.z, 0};
    reach |= spoke[i] < 0 ? -spoke[i] : spoke[i];
  }
  const int shift = std::max(0, bit_length(reach[0] | reach[1] | reach[2]) - kSpokeBits);
  for (std::uint32_t i = 0; i < spokes; ++i) {
    Spoke& s = spoke[i];
    s = (s >> shift) * 8;
    s[3] = static_cast<std::int32_t>(square_root(
        std::int64_t{s[0]} * s[0] + std::int64_t{s[1]} * s[1] + std::int64_t{s[2]} * s[2]));
  }
  Spoke sum{};
  sums_[0] = sum;
  for (std::uint32_t i = 0; i < spokes; ++i) sums_[i + 1] = sum += spoke[i];
  mean_length_ = std::max(1, sum[3] / static_cast<std::int32_t>(spokes));
  if (border_) return;
  for (std::uint32_t i = 0; i < spokes; ++i) sums_[spokes + i + 1] = sum += spoke[i];
}

// All lengths are sums over the run, so that no candidate costs a division: the mean inner spoke is
// inner / (length - 1), the mean cut spoke cut / 2, and the centre of polygon and vertex lies
// distance / (length + 2) away. The common denominator is score_unit_.
std::array<std::int64_t, 3> VertexRing::terms(std::uint32_t first, std::uint32_t length) const {
  const std::uint32_t last = first + length;
  const std::int64_t inner = length == 1 ? mean_length_ : (sums_[last] - sums_[first + 1])[3];
  const Spoke all_spokes = sums_[last + 1] - sums_[first];
  const std::int64_t cut = length == 1 ? all_spokes[3] : all_spokes[3] - inner;
  const Vec3l sum{all_spokes[0], all_spokes[1], all_spokes[2]};
  const std::int64_t distance = square_root(dot(sum, sum));
  const std::int64_t inners = std::max<std::int64_t>(1, length - 1), all = length + 2;
  return {2 * inner * all, cut * inners * all, 2 * distance * inners};
}

std::span<const VertexRing::Candidate> VertexRing::rank(const RefinableMesh& mesh,
                                                        std::uint32_t length,
                                                        const FanWeights& weights) {
  measure_spokes(mesh);
  score_unit_ = 2 * std::max<std::int64_t>(1, length - 1) * (length + 2) * mean_length_;
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < faces_; ++first) {
    if (run_[first] < length) continue;
    const std::array<std::int64_t, 3> of = terms(first, length);
    const Candidate candidate{weights.of[0] * of[0] + weights.of[1] * of[1] + weights.of[2] * of[2],
                              first};
    std::uint32_t at = count++;
    for (; at > 0 && candidates_[at - 1].score < candidate.score; --at) {
      candidates_[at] = candidates_[at - 1];
    }
    candidates_[at] = candidate;
  }
  return {candidates_.data(), count};
}

}  // namespace pmesh
