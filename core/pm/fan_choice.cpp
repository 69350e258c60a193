#include "core/pm/fan_choice.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace pmesh {
namespace {

// Spokes are measured in eighths, shifted right so far that they fit this many bits.
constexpr int kSpokeBits = 14;

}  // namespace

bool VertexRing::gather(const RefinableMesh& mesh, VertexId v,
                        const std::vector<std::uint8_t>& covered) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  const Vec3i* const positions = mesh.positions().data();
  const Int4 centre = int4(positions[v.value]);
  const HalfEdgeId first = connectivity.outgoing(v);
  HalfEdgeId h = first, last = first;
  std::uint32_t faces = 0, start = 0, smallest = first.value;
  std::uint64_t free = 0;
  Int4 reach{};
  do {
    if (faces == kMost) return false;
    const HalfEdgeId next = HalfEdgeMesh::next(h);
    const HalfEdgeId across = connectivity.twin(next);
    if (across.valid()) connectivity.prefetch_corners(across);  // for the patch
    half_edges_[faces] = h;
    spokes_[faces] = int4(positions[connectivity.origin(next).value]) - centre;
    reach |= magnitude(spokes_[faces]);
    free |= std::uint64_t{covered[HalfEdgeMesh::face(h).value] ^ 1u} << faces;
    const std::uint32_t is_smaller = 0 - static_cast<std::uint32_t>(h.value < smallest);
    start ^= (start ^ faces) & is_smaller;  // no branch: nobody could guess it
    smallest ^= (smallest ^ h.value) & is_smaller;
    ++faces;
    last = h;
    h = connectivity.rotate_ccw(h);
  } while (h.valid() && h != first);
  faces_ = faces;
  free_ = free;
  border_ = !h.valid();
  start_ = border_ ? 0 : start;
  if (border_) {
    spokes_[faces] = int4(positions[connectivity.apex(last).value]) - centre;
    reach |= magnitude(spokes_[faces]);
  } else {
    for (std::uint32_t i = 0; i < faces; ++i) half_edges_[faces + i] = half_edges_[i];
  }
  reach_ = reach;
  return true;
}

// A run of one face more begins where this one does, and the next face, too.
std::uint32_t VertexRing::find_runs() {
  const std::uint32_t longest = border_ ? faces_ : faces_ - 1;
  const int over_the_end = static_cast<int>(faces_) - 1;
  std::uint64_t runs = free_;
  std::uint32_t length = 0;
  while (runs != 0 && length < longest) {
    runs_[++length] = runs;
    runs &= runs >> 1 | (border_ ? 0 : (runs & 1) << over_the_end);
  }
  return length;
}

void VertexRing::measure_spokes() {
  const std::uint32_t spokes = border_ ? faces_ + 1 : faces_;
  const int shift = std::max(0, bit_length(reach_[0] | reach_[1] | reach_[2]) - kSpokeBits);
  Int4 sum{};
  std::int32_t length_sum = 0;
  sums_[0] = sum;
  length_sums_[0] = 0;
  for (std::uint32_t i = 0; i < spokes; ++i) {
    const Int4 spoke = (spokes_[i] >> shift) * 8;
    const Vec3l s = widen(spoke);
    sums_[i + 1] = sum += spoke;
    length_sums_[i + 1] = length_sum += static_cast<std::int32_t>(square_root(dot(s, s)));
  }
  mean_length_ = std::max(1, length_sum / static_cast<std::int32_t>(spokes));
  if (border_) return;
  for (std::uint32_t i = 0; i < spokes; ++i) {
    sums_[spokes + i + 1] = sum + sums_[i + 1];
    length_sums_[spokes + i + 1] = length_sum + length_sums_[i + 1];
  }
}

// All lengths are sums over the run, so that no candidate costs a division: the mean inner spoke is
// inner / (length - 1), the mean cut spoke cut / 2, and the centre of polygon and vertex lies
// distance / (length + 2) away. The common denominator is score_unit_.
VertexRing::Sums VertexRing::sums(std::uint32_t at) const {
  const std::uint32_t last = at + length_;
  const std::int64_t all = length_sums_[last + 1] - length_sums_[at];
  const std::int64_t between = length_sums_[last] - length_sums_[at + 1];
  const Int4 sum = sums_[last + 1] - sums_[at];
  const Vec3l centre = widen(sum);
  return {length_ == 1 ? mean_length_ : between, all - between, square_root(dot(centre, centre))};
}

std::array<std::int64_t, 3> VertexRing::units() const {
  const std::int64_t inners = std::max<std::int64_t>(1, length_ - 1), all = length_ + 2;
  return {2 * all, inners * all, 2 * inners};
}

std::array<std::int64_t, 3> VertexRing::terms(std::uint32_t first) const {
  const Sums of = sums(walked(first));
  const std::array<std::int64_t, 3> unit = units();
  return {unit[0] * of.inner, unit[1] * of.cut, unit[2] * of.distance};
}

void VertexRing::score(std::uint32_t length, const FanWeights& weights) {
  assert(length >= 1 && length <= kMost && runs_[length] != 0);
  measure_spokes();
  length_ = length;
  const std::array<std::int64_t, 3> unit = units();
  const std::int64_t inner = weights.of[0] * unit[0], cut = weights.of[1] * unit[1],
                     distance = weights.of[2] * unit[2];
  score_unit_ = unit[0] * std::max<std::int64_t>(1, length - 1) * mean_length_;
  candidate_count_ = 0;
  for (std::uint64_t left = runs_[length]; left != 0; left &= left - 1) {
    const auto at = static_cast<std::uint32_t>(std::countr_zero(left));
    const Sums of = sums(at);
    const std::int64_t score = inner * of.inner + cut * of.cut + distance * of.distance;
    const std::uint32_t first = at - start_ + (at < start_ ? faces_ : 0);
    candidates_[candidate_count_++] = score * kMost + (kMost - 1 - first);
  }
}

// No branch depends on which is likelier: nobody could guess it.
std::array<VertexRing::Candidate, 3> VertexRing::likeliest(Candidate bound) const {
  const auto swap_if_larger = [](Candidate& best, Candidate& candidate) {
    const Candidate gain = candidate - best, won = gain & ~(gain >> 63);
    best += won;
    candidate -= won;
  };
  Candidate first = kNone, second = kNone, third = kNone;
  for (std::uint32_t c = 0; c < candidate_count_; ++c) {
    Candidate candidate = candidates_[c];
    const Candidate too_likely = (bound - 1 - candidate) >> 63;
    candidate += (kNone - candidate) & too_likely;
    swap_if_larger(first, candidate);
    swap_if_larger(second, candidate);
    swap_if_larger(third, candidate);
  }
  return {first, second, third};
}

}  // namespace pmesh
