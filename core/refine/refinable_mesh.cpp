#include "core/refine/refinable_mesh.h"

#include <algorithm>
#include <cassert>

namespace pmesh {

Result<RefinableMesh> RefinableMesh::from_base(const LatticeMesh& base) {
  if (base.positions.size() >= kNoIndex) {
    return Error{ErrorCode::out_of_resources, "more vertices than 32-bit ids can name"};
  }
  Result<HalfEdgeMesh> connectivity =
      HalfEdgeMesh::build(base.triangles, static_cast<std::uint32_t>(base.positions.size()));
  if (!connectivity) return prefixed("base mesh", connectivity.error());
  RefinableMesh mesh;
  mesh.connectivity_ = std::move(*connectivity);
  mesh.positions_ = base.positions;
  return mesh;
}

void RefinableMesh::reserve(std::uint32_t vertices, std::uint32_t faces) {
  connectivity_.reserve(vertices, faces);
  positions_.reserve(vertices);
  sites_.reserve(vertices - base_vertices());
}

Status RefinableMesh::append(const VertexSplit& split) {
  assert(is_finest());
  if (Status status = connectivity_.check(split.site); !status) return status;
  if (positions_.size() + 1 >= kNoIndex) {
    return Error{ErrorCode::out_of_resources, "more vertices than 32-bit ids can name"};
  }
  positions_.push_back(split.position);
  append_relocation(split.relocation);
  sites_.push_back(split.site);
  refine_once();
  return {};
}

// Meshes without relocations take no memory for them.
void RefinableMesh::append_relocation(Vec3i relocation) {
  if (relocations_.empty()) {
    if (relocation == Vec3i{}) return;
    relocations_.reserve(sites_.capacity());
    relocations_.resize(known_splits());
  }
  relocations_.push_back(relocation);
}

void RefinableMesh::forget_finer() {
  positions_.resize(vertex_count());
  sites_.resize(applied_);
  if (!relocations_.empty()) relocations_.resize(applied_);
}

void RefinableMesh::refine_once() {
  const VertexId kept = connectivity_.split(sites_[applied_]);
  if (!relocations_.empty()) positions_[kept.value] += relocations_[applied_];
  ++applied_;
}

void RefinableMesh::coarsen_once() {
  const SplitSite& site = sites_[--applied_];
  connectivity_.undo_split(site);
  if (relocations_.empty()) return;
  Vec3i& kept = positions_[kept_vertex(connectivity_, site).value];
  kept = kept - relocations_[applied_];
}

void RefinableMesh::set_splits(std::uint32_t count) {
  assert(count <= known_splits());
  while (applied_ > count) coarsen_once();
  while (applied_ < count) refine_once();
}

void RefinableMesh::set_faces(std::uint64_t count) {
  while (applied_ > 0 && face_count() > count) coarsen_once();
  while (!is_finest() && face_count() + sites_[applied_].added_faces() <= count) refine_once();
}

void RefinableMesh::set_vertices(std::uint64_t count) {
  const std::uint64_t splits = count > base_vertices() ? count - base_vertices() : 0;
  set_splits(static_cast<std::uint32_t>(std::min<std::uint64_t>(splits, known_splits())));
}

LatticeMesh RefinableMesh::snapshot() const {
  LatticeMesh copy;
  copy.positions.assign(positions().begin(), positions().end());
  copy.triangles.reserve(face_count());
  const std::span<const VertexId> ids = corners();
  for (std::size_t c = 0; c < ids.size(); c += 3) {
    copy.triangles.push_back({ids[c].value, ids[c + 1].value, ids[c + 2].value});
  }
  return copy;
}

}  // namespace pmesh
