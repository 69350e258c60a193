#include "core/decimate/triangle_star.h"

#include <algorithm>

#include "core/decimate/face_turn.h"

namespace pmesh {
namespace {

bool contains(const std::vector<VertexId>& ring, VertexId v) {
  return std::find(ring.begin(), ring.end(), v) != ring.end();
}

// Precondition: `v` is no border vertex.
bool gather_ring(const HalfEdgeMesh& mesh, VertexId v, std::vector<VertexId>& ring) {
  ring.clear();
  const HalfEdgeId first = mesh.outgoing(v);
  HalfEdgeId h = first;
  do {
    if (ring.size() == TriangleStar::kMaxFaces) return false;
    ring.push_back(mesh.target(h));
    h = mesh.rotate_ccw(h);
  } while (h != first);
  return true;
}

// A vertex of valence three must go first: after any other collapse at the triangle its three
// neighbours would be joined by more than the triangle's edges. Elsewhere the order does not decide
// what is legal; few faces move this way.
void choose_order(TriangleStar& star) {
  star.order = {0, 1, 2};
  std::stable_sort(star.order.begin(), star.order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return star.rings[a].size() < star.rings[b].size();
  });
}

// Whether the face of corner `i` and its neighbours x and y is there after the collapse that moves
// the corner: the first moves the first and the last in order, the second then the other one.
bool survives(const TriangleStar& star, std::uint32_t i, VertexId x, VertexId y) {
  const std::uint32_t first = star.order[0], last = star.order[2];
  const auto has = [&](std::uint32_t corner) {
    return x == star.corners[corner] || y == star.corners[corner];
  };
  return (i == first || !has(first)) && (i == last || !has(last));
}

bool is_tetrahedron(std::size_t valence, std::size_t other) { return valence == 3 && other == 3; }

}  // namespace

bool gather_triangle(const WorkingMesh& work, FaceId face, TriangleStar& star) {
  const HalfEdgeMesh& mesh = work.mesh();
  for (std::uint32_t k = 0; k < 3; ++k) {
    star.corners[k] = mesh.corners()[std::size_t{3} * face.value + k];
    if (mesh.is_border(star.corners[k])) return false;
    star.positions[k] = work.position(star.corners[k]);
  }
  star.centroid = 1.0 / 3 * (star.positions[0] + star.positions[1] + star.positions[2]);
  const auto relative = [&](Vec3d p) { return work.frame().scale * (p - star.centroid); };
  for (std::uint32_t k = 0; k < 3; ++k) {
    const HalfEdgeId across(3 * face.value + (k + 1) % 3);
    star.positions[k] = relative(star.positions[k]);
    star.apexes[k] = relative(work.position(mesh.apex(mesh.twin(across))));
  }
  return true;
}

bool gather_star(const WorkingMesh& work, TriangleStar& star) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (!gather_ring(work.mesh(), star.corners[k], star.rings[k])) return false;
  }
  choose_order(star);
  star.faces.clear();
  const auto relative = [&](VertexId v) {
    return work.frame().scale * (work.position(v) - star.centroid);
  };
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::vector<VertexId>& ring = star.rings[k];
    VertexId second = ring.back();
    Vec3d at_second = relative(second);
    for (const VertexId third : ring) {
      const Vec3d at_third = relative(third);
      if (second != star.corners[(k + 1) % 3] || third != star.corners[(k + 2) % 3]) {
        star.faces.push_back(
            {star.positions[k], at_second, at_third, survives(star, k, second, third)});
      }
      second = third;
      at_second = at_third;
    }
  }
  return true;
}

bool link_conditions_hold(const TriangleStar& star) {
  const std::vector<VertexId>& first = star.rings[star.order[0]];
  const std::vector<VertexId>& second = star.rings[star.order[1]];
  const std::vector<VertexId>& last = star.rings[star.order[2]];
  const auto common =
      std::count_if(first.begin(), first.end(), [&](VertexId v) { return contains(last, v); });
  if (common != 2 || is_tetrahedron(first.size(), last.size())) return false;

  const VertexId removed = star.corners[star.order[0]], kept = star.corners[star.order[2]];
  const auto then_common = std::count_if(second.begin(), second.end(), [&](VertexId v) {
    return v != removed && v != kept && (contains(first, v) || contains(last, v));
  });
  return then_common == 2 && !is_tetrahedron(second.size() - 1, first.size() + last.size() - 4);
}

bool leaves_valence_three(const HalfEdgeMesh& mesh, FaceId face) {
  const auto has_four_faces = [&](HalfEdgeId first) {
    HalfEdgeId h = first;
    for (int count = 1; count <= 4; ++count) {
      h = mesh.rotate_ccw(h);
      if (!h.valid()) return false;
      if (h == first) return count == 4;
    }
    return false;
  };
  for (std::uint32_t k = 0; k < 3; ++k) {
    const HalfEdgeId across = mesh.twin(HalfEdgeId(3 * face.value + k));
    if (has_four_faces(HalfEdgeMesh::prev(across))) return true;
  }
  return false;
}

bool turns_faces(const TriangleStar& star, double least_cosine) {
  return std::any_of(star.faces.begin(), star.faces.end(), [&](const TriangleStar::Face& face) {
    return face.moves && turns(face.corner, face.second, face.third, {}, least_cosine);
  });
}

}  // namespace pmesh
