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
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (i + kAhead < order_.size()) {
      mesh.connectivity().prefetch(batch[order_[i + kAhead]].split.site.half_edge);
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
}

}  // namespace pmesh
