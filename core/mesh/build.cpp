// HalfEdgeMesh::build: from triangles to twins and anchors.
#include <string>

#include "core/mesh/edge_groups.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {
namespace {

using std::to_string;

Status check_indices(std::span<const Triangle> triangles, std::uint32_t vertex_count) {
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const auto [a, b, c] = triangles[f];
    if (a >= vertex_count || b >= vertex_count || c >= vertex_count) {
      return bad_input("face " + to_string(f) + " has a vertex index out of range");
    }
    if (a == b || b == c || c == a) {
      return bad_input("face " + to_string(f) + " repeats a vertex");
    }
  }
  return {};
}

std::string edge_name(VertexId a, VertexId b) {
  return "edge (" + to_string(a.value) + ", " + to_string(b.value) + ")";
}

}  // namespace

Result<HalfEdgeMesh> HalfEdgeMesh::build(std::span<const Triangle> triangles,
                                         std::uint32_t vertex_count) {
  if (Status status = check_indices(triangles, vertex_count); !status) return status.error();
  if (triangles.size() > kNoIndex / 3) {
    return Error{ErrorCode::out_of_resources, "more faces than 32-bit half-edge ids can name"};
  }
  HalfEdgeMesh mesh;
  mesh.reserve(vertex_count, static_cast<std::uint32_t>(triangles.size()));
  mesh.live_vertices_ = vertex_count;
  mesh.outgoing_.assign(vertex_count, HalfEdgeId());
  for (const auto [a, b, c] : triangles) mesh.append_face(VertexId(a), VertexId(b), VertexId(c));

  if (Status status = mesh.match_twins(triangles); !status) return status.error();
  if (Status status = mesh.anchor_vertices(); !status) return status.error();
  return mesh;
}

Status HalfEdgeMesh::match_twins(std::span<const Triangle> triangles) {
  Status status;
  for_each_edge(triangles, vertex_slots(), [&](std::span<const EdgeSide> sides) {
    if (!status || sides.size() == 1) return;
    const HalfEdgeId a(sides[0].half_edge), b(sides[1].half_edge);
    if (sides.size() > 2) {
      status = bad_input(edge_name(origin(a), target(a)) + " has more than two faces");
    } else if (origin(a) == origin(b)) {
      status = bad_input(edge_name(origin(a), target(a)) +
                         " has two faces that disagree in orientation");
    } else {
      set_twins(a, b);
    }
  });
  return status;
}

Status HalfEdgeMesh::anchor_vertices() {
  std::vector<std::uint32_t> corners_of(vertex_slots(), 0);
  for (std::uint32_t h = 0; h < origins_.size(); ++h) {
    const std::uint32_t v = origins_[h].value;
    ++corners_of[v];
    if (!outgoing_[v].valid() || is_border(HalfEdgeId(h))) outgoing_[v] = HalfEdgeId(h);
  }
  for (std::uint32_t v = 0; v < vertex_slots(); ++v) {
    const HalfEdgeId first = outgoing_[v];
    if (!first.valid()) return bad_input("vertex " + to_string(v) + " has no face");
    std::uint32_t fan = 0;
    HalfEdgeId h = first;
    do {
      ++fan;
      h = rotate_ccw(h);
    } while (h.valid() && h != first);
    if (fan != corners_of[v]) {
      return bad_input("vertex " + to_string(v) + " has more than one fan of faces");
    }
  }
  return {};
}

}  // namespace pmesh
