// HalfEdgeMesh's live part under other ids: closed up while a mesh is taken apart, and put back.
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {
namespace {

HalfEdgeId renumbered(HalfEdgeId h, std::span<const FaceId> faces) {
  if (!h.valid()) return h;
  return HalfEdgeId(3 * faces[h.value / 3].value + h.value % 3);
}

// The live ids below `slots`, and the place of each in that list. Without branches: in what is
// left of a mesh nobody can guess them.
template <class AnyId, class IsLive>
void number(std::uint32_t slots, std::uint32_t live, const IsLive& is_live,
            std::vector<AnyId>& old_ids, std::vector<AnyId>& new_ids) {
  old_ids.resize(live + 1);
  new_ids.resize(slots);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < slots; ++i) {
    old_ids[count] = AnyId(i);
    new_ids[i] = AnyId(count);
    count += is_live(AnyId(i));
  }
  assert(count == live);
  old_ids.resize(live);
}

}  // namespace

CompactIds HalfEdgeMesh::compact() {
  CompactIds ids;
  std::vector<FaceId> new_faces;
  const auto lives = [&](auto id) { return std::uint32_t{is_live(id)}; };
  number(vertex_slots(), live_vertices(), lives, ids.vertices, ids.new_vertices);
  number(face_slots(), live_faces(), lives, ids.faces, new_faces);
  for (std::size_t f = 0; f < ids.faces.size(); ++f) {  // in place: no id grows
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = 3 * std::size_t{ids.faces[f].value} + k, to = 3 * f + k;
      origins_[to] = ids.new_vertices[origins_[from].value];
      twins_[to] = renumbered(twins_[from], new_faces);
    }
  }
  origins_.resize(3 * ids.faces.size());
  twins_.resize(3 * ids.faces.size());
  close_up(outgoing_, ids.vertices);
  for (HalfEdgeId& h : outgoing_) h = renumbered(h, new_faces);
  return ids;
}

void HalfEdgeMesh::spread(std::span<const VertexId> vertices, std::span<const FaceId> faces,
                          std::uint32_t vertex_slots, std::uint32_t face_slots) {
  assert(vertices.size() == outgoing_.size() && 3 * faces.size() == twins_.size());
  const std::vector<VertexId> origins = origins_;
  const std::vector<HalfEdgeId> twins = twins_, outgoing = outgoing_;
  origins_.assign(std::size_t{3} * face_slots, VertexId());
  twins_.assign(std::size_t{3} * face_slots, HalfEdgeId());
  outgoing_.assign(vertex_slots, HalfEdgeId());
  for (std::size_t from = 0; from < twins.size(); ++from) {
    const std::size_t to = 3 * std::size_t{faces[from / 3].value} + from % 3;
    origins_[to] = vertices[origins[from].value];
    twins_[to] = renumbered(twins[from], faces);
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    outgoing_[vertices[v].value] = renumbered(outgoing[v], faces);
  }
}

}  // namespace pmesh
