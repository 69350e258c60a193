#include "core/pm/batch_builder.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace pmesh {
namespace {

// The number of faces from outgoing half-edge `first` on, ccw, before the spoke to `end`; nothing
// if they are more than may be moved, or `end` is not met.
std::optional<std::uint16_t> faces_until(const HalfEdgeMesh& mesh, HalfEdgeId first, VertexId end) {
  HalfEdgeId h = first;
  for (std::uint32_t faces = 1; faces <= kMaxMovedFaces; ++faces) {
    if (mesh.apex(h) == end) return static_cast<std::uint16_t>(faces);
    h = mesh.rotate_ccw(h);
    if (!h.valid() || h == first) return {};
  }
  return {};
}

std::optional<SplitSite> find_interior(const HalfEdgeMesh& mesh, const HalfEdgeCollapse& collapse) {
  const HalfEdgeId first = mesh.find_edge(collapse.kept, collapse.left);
  if (!first.valid() || mesh.origin(first) != collapse.kept) return {};
  const auto faces = faces_until(mesh, first, collapse.right);
  if (!faces) return {};
  return SplitSite{first, *faces, SplitKind::interior};
}

std::optional<SplitSite> find_border_first(const HalfEdgeMesh& mesh,
                                           const HalfEdgeCollapse& collapse) {
  const HalfEdgeId first = mesh.outgoing(collapse.kept);
  if (!mesh.is_border(first)) return {};
  if (mesh.target(first) == collapse.right) return SplitSite{first, 0, SplitKind::border_first};
  const auto faces = faces_until(mesh, first, collapse.right);
  if (!faces) return {};
  return SplitSite{first, *faces, SplitKind::border_first};
}

std::optional<SplitSite> find_border_last(const HalfEdgeMesh& mesh,
                                          const HalfEdgeCollapse& collapse) {
  HalfEdgeId h = mesh.find_edge(collapse.kept, collapse.left);
  if (!h.valid()) return {};
  if (mesh.origin(h) != collapse.kept) return SplitSite{h, 0, SplitKind::border_last};
  for (std::uint32_t faces = 1; faces <= kMaxMovedFaces; ++faces) {
    const HalfEdgeId next = mesh.rotate_ccw(h);
    if (!next.valid()) {
      return SplitSite{mesh.prev(h), static_cast<std::uint16_t>(faces), SplitKind::border_last};
    }
    h = next;
  }
  return {};
}

}  // namespace

std::optional<SplitSite> find_site(const HalfEdgeMesh& mesh, const HalfEdgeCollapse& collapse) {
  if (!collapse.left.valid()) return find_border_first(mesh, collapse);
  if (!collapse.right.valid()) return find_border_last(mesh, collapse);
  return find_interior(mesh, collapse);
}

BatchBuilder::BatchBuilder(const CollapseLog& log, std::span<const Vec3i> positions,
                           const Lattice& lattice)
    : log_(log),
      positions_(positions),
      lattice_(lattice),
      file_ids_(positions.size()),
      kept_in_(positions.size()) {}

void BatchBuilder::add(std::span<const std::uint32_t> splits) {
  const auto added = static_cast<std::ptrdiff_t>(to_come_.size());
  to_come_.insert(to_come_.end(), splits.begin(), splits.end());
  std::inplace_merge(to_come_.begin(), to_come_.begin() + added, to_come_.end());
}

std::vector<BatchSplit> BatchBuilder::next(const RefinableMesh& mesh, BatchMesh& state) {
  Batch batch;
  Fan fan;
  ++batch_number_;
  while (!to_come_.empty()) {
    const std::optional<BatchSplit> entry = split_at(to_come_.back(), mesh);
    if (!entry) break;
    std::uint32_t& kept_in = kept_in_[entry->kept.value];
    if (kept_in == batch_number_) break;
    fan.walk(mesh.connectivity(), entry->split.site);
    if (!state.is_free(fan)) break;
    kept_in = batch_number_;
    state.cover(mesh, fan);
    batch.emplace_back(*entry, to_come_.back());
    to_come_.pop_back();
  }
  assert(to_come_.empty() || !batch.empty());
  state.uncover(mesh);
  sort(batch, state);
  std::vector<BatchSplit> splits;
  batch_.clear();
  for (const auto& [entry, place] : batch) {
    splits.push_back(entry);
    batch_.push_back(place);
  }
  return splits;
}

void BatchBuilder::sort(Batch& batch, BatchMesh& state) {
  const bool by_id = state.order_of(batch.size()) == BatchOrder::ids;
  if (!by_id) {
    place_.resize(state.vertices_to_sweep().size());
    std::uint32_t place = 0;
    for (const VertexId v : state.vertices_to_sweep()) place_[v.value] = place++;
  }
  const auto place = [&](VertexId v) { return by_id ? v.value : place_[v.value]; };
  std::sort(batch.begin(), batch.end(), [&](const auto& a, const auto& b) {
    return place(a.first.kept) < place(b.first.kept);
  });
}

void BatchBuilder::applied(std::size_t begin, std::span<const std::uint32_t> order,
                           std::uint32_t first_vertex) {
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const VertexId removed = log_.collapses[batch_[begin + order[i]]].removed;
    file_ids_[removed.value] = VertexId(first_vertex + i);
  }
}

std::size_t BatchBuilder::batch_size_ahead() const {
  const std::vector<std::uint32_t>& ends = log_.batch_ends;
  if (ends.empty()) return 1;
  const auto end = std::upper_bound(ends.begin(), ends.end(), to_come_.back());
  const std::uint32_t begin = end == ends.begin() ? 0 : *(end - 1);
  return static_cast<std::size_t>(to_come_.end() -
                                  std::lower_bound(to_come_.begin(), to_come_.end(), begin));
}

// Nothing if it needs a split that is not applied yet.
std::optional<BatchSplit> BatchBuilder::split_at(std::size_t index,
                                                 const RefinableMesh& mesh) const {
  const HalfEdgeCollapse& collapse = log_.collapses[index];
  const HalfEdgeCollapse renamed{VertexId(), file_id(collapse.kept), file_id(collapse.left),
                                 file_id(collapse.right)};
  if (!renamed.kept.valid() || (collapse.left.valid() && !renamed.left.valid()) ||
      (collapse.right.valid() && !renamed.right.valid())) {
    return {};
  }
  const std::optional<SplitSite> site = find_site(mesh.connectivity(), renamed);
  if (!site) return {};
  BatchSplit entry{{*site, positions_[collapse.removed.value]}, renamed.kept};
  if (!log_.kept_before.empty()) {
    entry.split.relocation =
        lattice_.quantise(log_.kept_before[index]) - mesh.positions()[renamed.kept.value];
  }
  return entry;
}

}  // namespace pmesh
