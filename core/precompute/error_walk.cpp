#include "core/precompute/error_walk.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "core/measure/patch_distance.h"
#include "core/precompute/displacements.h"

namespace pmesh {
ErrorWalk::ErrorWalk(RefinableMesh& mesh, const Lattice& lattice, const IndexedMesh& original,
                     const UnitFrame& frame)
    : mesh_(mesh), positions_(lattice), frame_(frame) {
  mesh_.set_finest();
  errors_ = FaceErrors(mesh_.face_count());
  const Displacements displacements(original, lattice);
  std::vector<double> of_vertices;
  of_vertices.reserve(mesh_.positions().size());
  for (const Vec3i point : mesh_.positions()) {
    of_vertices.push_back(frame.scale * displacements.at(point));
  }
  const std::span<const VertexId> corners = mesh_.corners();
  for (std::uint32_t face = 0; face < errors_.size(); ++face) {
    const auto at = [&](std::size_t k) { return of_vertices[corners[3 * face + k].value]; };
    errors_.to_original[face] = errors_.from_original[face] = std::max({at(0), at(1), at(2)});
  }
}

void ErrorWalk::plan_to(std::uint64_t vertices) {
  while (mesh_.vertex_count() > vertices && mesh_.applied_steps() > 0) {
    if (mesh_.last_is_arrival()) {
      plan_leave();
    } else {
      plan_collapse();
    }
  }
}

void ErrorWalk::follow() {
  for (std::size_t i = 0; i < exchanges_.size(); ++i) {
    const std::size_t end =
        i + 1 < exchanges_.size() ? exchanges_[i + 1].star_begin : exchanged_.size();
    exchange(exchanges_[i], static_cast<std::uint32_t>(end));
  }
  errors_.resize(mesh_.face_count());
  exchanges_.clear();
  exchanged_.clear();
}

Corners ErrorWalk::corners(std::uint32_t face) const {
  const std::span<const VertexId> of_face = mesh_.corners().subspan(3 * std::size_t{face}, 3);
  return {position(of_face[0]), position(of_face[1]), position(of_face[2])};
}

void ErrorWalk::plan_collapse() {
  const VertexId removed(mesh_.vertex_count() - 1);
  // The split's last face is (removed, right, kept), or, without one, (removed, kept, left).
  const SplitSite site = mesh_.last_site();
  const std::size_t corner = site.kind == SplitKind::border_last ? 1 : 2;
  const VertexId kept = mesh_.corners()[3 * (std::size_t{mesh_.face_count()} - 1) + corner];
  gather(removed, kept);
  const double gap = gap_of(removed, kept);
  mesh_.set_steps(mesh_.applied_steps() - 1);
  // If nothing but an edge is left of the star, its other face has what was charged to the star.
  if (star_.size() == 1) around_.push_back(HalfEdgeMesh::face(site.half_edge).value);

  const auto begin = static_cast<std::uint32_t>(exchanged_.size());
  const auto around_begin = static_cast<std::uint32_t>(begin + star_.size());
  exchanges_.push_back({gap, mesh_.face_count(), begin, around_begin});
  exchanged_.insert(exchanged_.end(), star_.begin(), star_.end());
  exchanged_.insert(exchanged_.end(), around_.begin(), around_.end());
}

// All that was charged to the components is charged to the base's first face, at an unknown
// distance.
void ErrorWalk::plan_leave() {
  mesh_.set_steps(mesh_.applied_steps() - 1);
  const auto begin = static_cast<std::uint32_t>(exchanged_.size());
  exchanges_.push_back({std::numeric_limits<double>::infinity(), mesh_.face_count(), begin, begin});
  exchanged_.push_back(0);
}

void ErrorWalk::gather(VertexId removed, VertexId kept) {
  star_.clear();
  around_.clear();
  on_border_ = gather_star(removed, kept);
  const Vec3i relocation = mesh_.last_relocation();
  merged_ = unit(mesh_.positions()[kept.value] - relocation);
  if (relocation == Vec3i{}) return;
  removed_link_ = link_;
  on_border_ |= gather_star(kept, removed);
  std::sort(star_.begin(), star_.end());
  star_.erase(std::unique(star_.begin(), star_.end()), star_.end());
}

// The faces of `center`, and its link from the vertex `first` on. Whether it is on a border.
bool ErrorWalk::gather_star(VertexId center, VertexId first) {
  const HalfEdgeMesh& mesh = mesh_.connectivity();
  const HalfEdgeId begin = mesh.outgoing(center);
  link_.clear();
  HalfEdgeId h = begin, last;
  do {
    star_.push_back(HalfEdgeMesh::face(h).value);
    link_.push_back(mesh.target(h));
    last = h;
    h = mesh.rotate_ccw(h);
  } while (h.valid() && h != begin);
  if (h.valid()) {
    std::rotate(link_.begin(), std::find(link_.begin(), link_.end(), first), link_.end());
    return false;
  }
  link_.push_back(mesh.apex(last));
  if (link_.back() == first) std::reverse(link_.begin(), link_.end());
  return true;
}

double ErrorWalk::gap_of(VertexId removed, VertexId kept) {
  if (const std::optional<double> gap = plain_gap(removed, kept)) return *gap;
  gather_around();
  // The linear maps of the faces onto their images move no point farther than the vertices.
  const double moved =
      std::max(length(position(removed) - merged_), length(position(kept) - merged_));
  return odd_gap(removed, kept, moved);
}

std::optional<double> ErrorWalk::plain_gap(VertexId removed, VertexId kept) {
  const bool relocates = mesh_.last_relocation() != Vec3i{};
  if (relocates && on_border_) return std::nullopt;
  if (relocates) {  // the link from left round removed to right, and on round kept
    link_.erase(link_.begin(), link_.begin() + 2);
    link_.pop_back();
    link_.insert(link_.begin(), removed_link_.begin() + 1, removed_link_.end());
  }
  link_positions_.clear();
  for (const VertexId v : link_) link_positions_.push_back(position(v));
  if (!relocates) return gap_.of_half_edge(position(removed), link_positions_, on_border_);
  return gap_.of_edge(position(removed), position(kept), merged_, link_positions_,
                      removed_link_.size() - 2);
}

void ErrorWalk::gather_around() {
  for (const std::uint32_t face : star_) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const HalfEdgeId twin = mesh_.connectivity().twin(HalfEdgeId(3 * face + k));
      if (!twin.valid()) continue;
      const std::uint32_t beyond = HalfEdgeMesh::face(twin).value;
      const bool is_in_star = std::find(star_.begin(), star_.end(), beyond) != star_.end();
      if (!is_in_star) around_.push_back(beyond);
    }
  }
}

// The faces beyond the link belong to both surfaces: folded faces may be above or below them.
double ErrorWalk::odd_gap(VertexId removed, VertexId kept, double limit) {
  std::vector<Corners> before, after, around;
  for (const std::uint32_t face : star_) {
    const Corners t = corners(face);
    before.push_back(t);
    const std::span<const VertexId> ids = mesh_.corners().subspan(3 * std::size_t{face}, 3);
    const auto moved = [&](std::size_t k, Vec3d p) {
      return ids[k] == removed || ids[k] == kept ? merged_ : p;
    };
    const bool is_deleted =
        std::count(ids.begin(), ids.end(), removed) + std::count(ids.begin(), ids.end(), kept) == 2;
    if (!is_deleted) after.push_back({moved(0, t.a), moved(1, t.b), moved(2, t.c)});
  }
  for (const std::uint32_t face : around_) around.push_back(corners(face));
  const auto found = [&](int effort) {
    return std::max(patch_distance(before, after, around, limit, effort),
                    patch_distance(after, before, around, limit, effort));
  };
  // A bound that may be much too large: many faces can lie in many ways.
  const auto is_large = [&](double gap) { return star_.size() > 8 && gap > limit / 3; };
  constexpr int kMoreEffort = 6;
  const double gap = found(1);
  return is_large(gap) ? found(kMoreEffort) : gap;
}

// The star's bounds become those of what has replaced it.
void ErrorWalk::exchange(const Exchange& exchange, std::uint32_t end) {
  const std::span<const std::uint32_t> all(exchanged_);
  const auto star = all.subspan(exchange.star_begin, exchange.around_begin - exchange.star_begin);
  const auto around = all.subspan(exchange.around_begin, end - exchange.around_begin);
  double to = 0, from = 0;
  for (const std::uint32_t face : star) {
    to = std::max(to, errors_.to_original[face]);
    from = std::max(from, errors_.from_original[face]);
  }
  for (const std::uint32_t face : around) {
    to = std::max(to, errors_.to_original[face]);
    errors_.from_original[face] = std::max(errors_.from_original[face], from + exchange.gap);
  }
  for (const std::uint32_t face : star) {
    if (face >= exchange.faces_after) continue;
    errors_.to_original[face] = to + exchange.gap;
    errors_.from_original[face] = from + exchange.gap;
  }
}

}  // namespace pmesh
