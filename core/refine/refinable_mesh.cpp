#include "core/refine/refinable_mesh.h"

#include <cassert>
#include <utility>

namespace pmesh {
namespace {

Status check_nameable(std::uint64_t vertices) {
  if (vertices < kNoIndex) return {};
  return Error{ErrorCode::out_of_resources, "more vertices than 32-bit ids can name"};
}

// Of a mesh that joins one of that many vertices.
Result<HalfEdgeMesh> connect(const LatticeMesh& mesh, std::uint64_t vertices_before) {
  const std::size_t vertices = mesh.positions.size();
  if (Status few = check_nameable(vertices_before + vertices); !few) return few.error();
  return HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(vertices));
}

}  // namespace

Result<RefinableMesh> RefinableMesh::from_base(const LatticeMesh& base) {
  Result<HalfEdgeMesh> connectivity = connect(base, 0);
  if (!connectivity) return prefixed("base mesh", connectivity.error());
  RefinableMesh mesh;
  mesh.connectivity_ = std::move(*connectivity);
  mesh.positions_ = base.positions;
  return mesh;
}

void RefinableMesh::reserve(std::uint32_t vertices, std::uint32_t faces) {
  connectivity_.reserve(vertices, faces);
  positions_.reserve(vertices);
  sites_.reserve(sites_.size() + vertices - known_vertices());
}

Status RefinableMesh::append(const VertexSplit& split) {
  assert(is_finest());
  if (Status status = connectivity_.check(split.site); !status) return status;
  if (Status few = check_nameable(positions_.size() + 1); !few) return few;
  positions_.push_back(split.position);
  append_step(split.site, split.relocation);
  return {};
}

Status RefinableMesh::append(const LatticeMesh& components) {
  assert(is_finest());
  if (components.triangles.empty()) return bad_input("new components: no face");
  Result<HalfEdgeMesh> connectivity = connect(components, positions_.size());
  if (!connectivity) return prefixed("new components", connectivity.error());
  if (connectivity->live_faces() > kNoIndex / 3 - face_count()) {
    return Error{ErrorCode::out_of_resources, "more faces than 32-bit half-edge ids can name"};
  }
  positions_.insert(positions_.end(), components.positions.begin(), components.positions.end());
  arrivals_.push_back(std::move(*connectivity));
  append_step({}, {});
  return {};
}

// Meshes without relocations take no memory for them.
void RefinableMesh::append_step(const SplitSite& site, Vec3i relocation) {
  if (relocations_.empty() && relocation != Vec3i{}) {
    relocations_.reserve(sites_.capacity());
    relocations_.resize(known_steps());
  }
  if (!relocations_.empty() || relocation != Vec3i{}) relocations_.push_back(relocation);
  sites_.push_back(site);
  refine_once();
}

void RefinableMesh::forget_finer() {
  positions_.resize(vertex_count());
  arrivals_.erase(arrivals_.begin() + arrived_, arrivals_.end());
  sites_.resize(applied_);
  if (!relocations_.empty()) relocations_.resize(applied_);
}

std::uint32_t RefinableMesh::added_vertices() const {
  return is_arrival(applied_) ? arrivals_[arrived_].live_vertices() : 1;
}

std::uint32_t RefinableMesh::added_faces() const {
  return is_arrival(applied_) ? arrivals_[arrived_].live_faces()
                              : static_cast<std::uint32_t>(sites_[applied_].added_faces());
}

void RefinableMesh::refine_once() {
  if (is_arrival(applied_)) {
    connectivity_.append(arrivals_[arrived_++]);
    ++applied_;
    return;
  }
  const VertexId kept = connectivity_.split(sites_[applied_]);
  if (!relocations_.empty()) positions_[kept.value] += relocations_[applied_];
  ++applied_;
}

void RefinableMesh::coarsen_once() {
  if (is_arrival(--applied_)) {
    const HalfEdgeMesh& leaving = arrivals_[--arrived_];
    return connectivity_.undo_append(leaving.live_vertices(), leaving.live_faces());
  }
  const SplitSite& site = sites_[applied_];
  connectivity_.undo_split(site);
  if (relocations_.empty()) return;
  Vec3i& kept = positions_[kept_vertex(connectivity_, site).value];
  kept = kept - relocations_[applied_];
}

void RefinableMesh::set_steps(std::uint32_t count) {
  assert(count <= known_steps());
  while (applied_ > count) coarsen_once();
  while (applied_ < count) refine_once();
}

void RefinableMesh::set_faces(std::uint64_t count) {
  while (applied_ > 0 && face_count() > count) coarsen_once();
  while (!is_finest() && std::uint64_t{face_count()} + added_faces() <= count) refine_once();
}

void RefinableMesh::set_vertices(std::uint64_t count) {
  while (applied_ > 0 && vertex_count() > count) coarsen_once();
  while (!is_finest() && std::uint64_t{vertex_count()} + added_vertices() <= count) refine_once();
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
