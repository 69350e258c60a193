#include "core/pm/batch_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace pmesh {
namespace {

// Costs are sorted by octaves alone, and in windows: so neighbours, which stand near each other in
// the order of the kept vertices, are split while the caches hold them, and come to lie near each
// other.
constexpr std::size_t kWindow = 4096;
constexpr int kMostCost = 127;
int bucket(int cost) { return std::clamp(cost / 2, 0, kMostCost); }

}  // namespace

BatchMesh::BatchMesh(const RefinableMesh& mesh) { grow(mesh); }

void BatchMesh::grow(const RefinableMesh& mesh) {
  const std::span<const VertexId> corners_of_new = mesh.corners().subspan(3 * covered_.size());
  counts_.resize(mesh.vertex_count());
  covered_.resize(mesh.face_count());
  for (const VertexId v : corners_of_new) ++counts_[v.value].faces;
  while (families_.size() < counts_.size()) families_.push_back(family_count_++);
}

void BatchMesh::cover(const RefinableMesh& mesh, const Fan& fan) {
  const std::span<const VertexId> corners = mesh.corners();
  for (const HalfEdgeId h : fan.half_edges()) {
    const FaceId f = HalfEdgeMesh::face(h);
    covered_[f.value] = 1;
    covered_faces_.push_back(f);
    for (const VertexId v : corners.subspan(3 * std::size_t{f.value}, 3)) {
      ++counts_[v.value].covered;
    }
  }
}

// Of many faces one by one would cost more than all, which lie in a row.
void BatchMesh::uncover(const RefinableMesh& mesh) {
  if (8 * covered_faces_.size() > covered_.size()) {
    std::ranges::fill(covered_, 0);
    for (FaceCounts& counts : counts_) counts.covered = 0;
  } else {
    for (const FaceId f : covered_faces_) {
      covered_[f.value] = 0;
      for (const VertexId v : mesh.corners().subspan(3 * std::size_t{f.value}, 3)) {
        counts_[v.value].covered = 0;
      }
    }
  }
  covered_faces_.clear();
}

Status BatchMesh::apply(std::span<const BatchSplit> batch, RefinableMesh& mesh) {
  uncover(mesh);
  sort(batch);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    prefetch(batch, i, mesh.connectivity());
    if (Status status = mesh.append(batch[order_[i]].split); !status) return status;
    count_faces_of_last(mesh);
  }
  return {};
}

// What the splits after place `place` of the order need: the further off they are, the less is
// there to go by.
void BatchMesh::prefetch(std::span<const BatchSplit> batch, std::size_t place,
                         const HalfEdgeMesh& mesh) const {
  constexpr std::size_t kStage = 8;
  const auto at = [&](std::size_t stage) -> const BatchSplit* {
    const std::size_t ahead = place + stage * kStage;
    return ahead < order_.size() ? &batch[order_[ahead]] : nullptr;
  };
  if (const BatchSplit* split = at(3)) __builtin_prefetch(split);
  if (const BatchSplit* split = at(2)) mesh.prefetch(split->split.site.half_edge);
  if (const BatchSplit* split = at(1)) mesh.prefetch_neighbours(split->split.site.half_edge);
}

// A counting sort: costs are few.
void BatchMesh::sort(std::span<const BatchSplit> batch) {
  order_.resize(batch.size());
  for (std::size_t begin = 0; begin < batch.size(); begin += kWindow) {
    const std::size_t end = std::min(batch.size(), begin + kWindow);
    std::array<std::uint32_t, kMostCost + 2> starts{};
    for (std::size_t i = begin; i < end; ++i) ++starts[kMostCost - bucket(batch[i].cost) + 1];
    starts[0] = static_cast<std::uint32_t>(begin);
    for (std::size_t c = 1; c < starts.size(); ++c) starts[c] += starts[c - 1];
    for (std::size_t i = begin; i < end; ++i) {
      order_[starts[kMostCost - bucket(batch[i].cost)]++] = static_cast<std::uint32_t>(i);
    }
  }
}

void BatchMesh::begin_sweep() {
  assert(may_sweep());
  vertices_to_sweep();
  swept_ = 0;
  swept_at_ = counts_.size();
}

// A counting sort, once a sweep.
std::span<const VertexId> BatchMesh::vertices_to_sweep() {
  if (sweep_.size() == families_.size()) return sweep_;
  family_starts_.assign(family_count_ + 1, 0);
  for (const std::uint32_t family : families_) ++family_starts_[family + 1];
  for (std::size_t f = 1; f < family_count_; ++f) family_starts_[f + 1] += family_starts_[f];
  sweep_.resize(families_.size());
  swept_ = sweep_.size();
  for (std::uint32_t v = 0; v < families_.size(); ++v) {
    sweep_[family_starts_[families_[v]]++] = VertexId(v);
  }
  return sweep_;
}

// Valences after the split just applied, from the faces that it added: L = (added, kept, left) and
// R = (added, right, kept).
void BatchMesh::count_faces_of_last(const RefinableMesh& mesh) {
  const SplitSite& site = mesh.last_site();
  const auto added_faces = static_cast<std::uint32_t>(site.added_faces());
  const std::span<const VertexId> corners = mesh.corners();
  counts_.emplace_back();
  covered_.insert(covered_.end(), added_faces, 0);
  const VertexId added = corners[corners.size() - 3];
  for (const VertexId v : corners.last(3 * std::size_t{added_faces})) ++counts_[v.value].faces;
  counts_[added.value].faces += site.moved_faces;
  const VertexId kept = site.kind == SplitKind::border_last ? corners[corners.size() - 2]
                                                            : corners[corners.size() - 1];
  counts_[kept.value].faces -= site.moved_faces;
  families_.push_back(families_[kept.value]);
}

}  // namespace pmesh
