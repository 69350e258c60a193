// HalfEdgeMesh's live part, and the check of every invariant against a mesh built anew from it.
#include <string>

#include "core/mesh/half_edge_mesh.h"

namespace pmesh {
namespace {

using std::to_string;

// The half-edge of `mesh` that half-edge `h` of the mesh built from `live` stands for.
HalfEdgeId original(const LiveMesh& live, HalfEdgeId h) {
  if (!h.valid()) return h;
  return HalfEdgeId(3 * live.faces[h.value / 3].value + h.value % 3);
}

Status check_twins(const HalfEdgeMesh& mesh, const LiveMesh& live, const HalfEdgeMesh& rebuilt) {
  for (std::uint32_t h = 0; h < 3 * live.faces.size(); ++h) {
    const HalfEdgeId here = original(live, HalfEdgeId(h));
    if (mesh.twin(here) != original(live, rebuilt.twin(HalfEdgeId(h)))) {
      return bad_input("face " + to_string(here.value / 3) + " has a wrong twin");
    }
  }
  return {};
}

Status check_anchors(const HalfEdgeMesh& mesh, const LiveMesh& live, const HalfEdgeMesh& rebuilt) {
  for (std::uint32_t v = 0; v < live.vertices.size(); ++v) {
    const VertexId here = live.vertices[v];
    const HalfEdgeId h = mesh.outgoing(here);
    if (h.value >= 3 * mesh.face_slots() || mesh.origin(h) != here) {
      return bad_input("vertex " + to_string(here.value) + " has a wrong outgoing half-edge");
    }
    if (rebuilt.is_border(VertexId(v)) != mesh.is_border(h)) {
      return bad_input("border vertex " + to_string(here.value) + " is not anchored at its border");
    }
  }
  return {};
}

}  // namespace

LiveMesh HalfEdgeMesh::live() const {
  LiveMesh live;
  live.triangles.reserve(live_faces());
  live.faces.reserve(live_faces());
  live.vertices.reserve(live_vertices());
  std::vector<std::uint32_t> compact(vertex_slots(), kNoIndex);
  for (std::uint32_t v = 0; v < vertex_slots(); ++v) {
    if (!is_live(VertexId(v))) continue;
    compact[v] = static_cast<std::uint32_t>(live.vertices.size());
    live.vertices.push_back(VertexId(v));
  }
  for (std::uint32_t f = 0; f < face_slots(); ++f) {
    if (!is_live(FaceId(f))) continue;
    Triangle corners;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = origins_[3 * f + k].value;
      corners[k] = v < compact.size() ? compact[v] : kNoIndex;
    }
    live.triangles.push_back(corners);
    live.faces.push_back(FaceId(f));
  }
  return live;
}

Status HalfEdgeMesh::validate() const {
  const LiveMesh live_part = live();
  if (live_part.vertices.size() != live_vertices_ || live_part.faces.size() != live_faces_) {
    return bad_input("the live counts are wrong");
  }
  const Result<HalfEdgeMesh> rebuilt = build(live_part.triangles, live_vertices_);
  if (!rebuilt) return rebuilt.error();
  if (Status status = check_twins(*this, live_part, *rebuilt); !status) return status;
  return check_anchors(*this, live_part, *rebuilt);
}

}  // namespace pmesh
