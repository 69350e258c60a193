#include "core/pm/batch_mesh.h"

#include <algorithm>
#include <array>

namespace pmesh {
namespace {

// Costs are sorted by octaves alone: inside one, the order of the kept vertices keeps neighbours
// near each other in memory.
constexpr int kMostCost = 127;
int bucket(int cost) { return std::clamp(cost / 2, 0, kMostCost); }

}  // namespace

BatchMesh::BatchMesh(const RefinableMesh& mesh) { grow(mesh); }

void BatchMesh::grow(const RefinableMesh& mesh) {
  const std::span<const VertexId> corners_of_new = mesh.corners().subspan(3 * covered_.size());
  valences_.resize(mesh.vertex_count());
  covered_at_.resize(mesh.vertex_count());
  covered_.resize(mesh.face_count());
  for (const VertexId v : corners_of_new) ++valences_[v.value];
  while (families_.size() < valences_.size()) families_.push_back(family_count_++);
}

void BatchMesh::cover(const RefinableMesh& mesh, const SplitSite& site) {
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  cover(mesh, HalfEdgeMesh::face(site.half_edge));
  const bool clockwise = site.kind == SplitKind::border_last;
  HalfEdgeId h = clockwise ? connectivity.next(site.half_edge) : site.half_edge;
  for (std::uint32_t face = 1; face < site.moved_faces; ++face) {
    h = clockwise ? connectivity.rotate_cw(h) : connectivity.rotate_ccw(h);
    cover(mesh, HalfEdgeMesh::face(h));
  }
}

void BatchMesh::cover(const RefinableMesh& mesh, FaceId f) {
  covered_[f.value] = 1;
  covered_faces_.push_back(f);
  for (const VertexId v : mesh.corners().subspan(3 * std::size_t{f.value}, 3)) {
    ++covered_at_[v.value];
  }
}

void BatchMesh::uncover(const RefinableMesh& mesh) {
  for (const FaceId f : covered_faces_) {
    covered_[f.value] = 0;
    for (const VertexId v : mesh.corners().subspan(3 * std::size_t{f.value}, 3)) {
      covered_at_[v.value] = 0;
    }
  }
  covered_faces_.clear();
}

Status BatchMesh::apply(std::span<const BatchSplit> batch, RefinableMesh& mesh) {
  uncover(mesh);
  sort(batch);
  last_kept_ = batch.back().kept;
  constexpr std::size_t kAhead = 8;
  const HalfEdgeMesh& connectivity = mesh.connectivity();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (i + 2 * kAhead < order_.size()) {
      connectivity.prefetch(batch[order_[i + 2 * kAhead]].split.site.half_edge);
    }
    if (i + kAhead < order_.size()) {
      connectivity.prefetch_neighbours(batch[order_[i + kAhead]].split.site.half_edge);
    }
    if (Status status = mesh.append(batch[order_[i]].split); !status) return status;
    count_faces_of_last(mesh);
  }
  return {};
}

// A counting sort: costs are few.
void BatchMesh::sort(std::span<const BatchSplit> batch) {
  order_.resize(batch.size());
  std::array<std::uint32_t, kMostCost + 2> starts{};
  for (const BatchSplit& entry : batch) ++starts[kMostCost - bucket(entry.cost) + 1];
  for (std::size_t c = 1; c < starts.size(); ++c) starts[c] += starts[c - 1];
  for (std::uint32_t i = 0; i < batch.size(); ++i) {
    order_[starts[kMostCost - bucket(batch[i].cost)]++] = i;
  }
}

// A counting sort, once a batch.
std::span<const VertexId> BatchMesh::sweep() {
  if (sweep_.size() == families_.size()) return sweep_;
  family_starts_.assign(family_count_ + 1, 0);
  for (const std::uint32_t family : families_) ++family_starts_[family + 1];
  for (std::size_t f = 1; f < family_count_; ++f) family_starts_[f + 1] += family_starts_[f];
  sweep_.resize(families_.size());
  for (std::uint32_t v = 0; v < families_.size(); ++v) {
    sweep_[family_starts_[families_[v]]++] = VertexId(v);
  }
  return sweep_;
}

std::span<const VertexId> BatchMesh::rest_of_sweep() {
  const std::span<const VertexId> all = sweep();
  const auto last = std::find(all.begin(), all.end(), last_kept_);
  return all.subspan(static_cast<std::size_t>(last - all.begin()) + 1);
}

// Valences after the split just applied, from the faces that it added: L = (added, kept, left) and
// R = (added, right, kept).
void BatchMesh::count_faces_of_last(const RefinableMesh& mesh) {
  const SplitSite& site = mesh.last_site();
  const auto added_faces = static_cast<std::uint32_t>(site.added_faces());
  const std::span<const VertexId> corners = mesh.corners();
  valences_.push_back(0);
  covered_at_.push_back(0);
  covered_.insert(covered_.end(), added_faces, 0);
  const VertexId added = corners[corners.size() - 3];
  for (const VertexId v : corners.last(3 * std::size_t{added_faces})) ++valences_[v.value];
  valences_[added.value] += site.moved_faces;
  const VertexId kept = site.kind == SplitKind::border_last ? corners[corners.size() - 2]
                                                            : corners[corners.size() - 1];
  valences_[kept.value] -= site.moved_faces;
  families_.push_back(families_[kept.value]);
}

}  // namespace pmesh
