#include "core/decimate/edge_star.h"

#include <algorithm>

#include "core/decimate/face_turn.h"

namespace pmesh {
namespace {

// Gathers the faces of one end of the edge, which `outgoing` leaves towards the other end, but not
// the edge's own, and the end's border edges but for the edge itself.
class FanGatherer {
 public:
  FanGatherer(const WorkingMesh& work, EdgeStar& star)
      : mesh_(work.mesh()),
        work_(work),
        scale_(work.frame().scale),
        middle_(0.5 * (work.position(star.a) + work.position(star.b))),
        star_(star) {}

  bool gather(VertexId end, bool is_a) {
    const VertexId other = is_a ? star_.b : star_.a;
    const Vec3d at = is_a ? star_.position_a : star_.position_b;
    const HalfEdgeId first = mesh_.outgoing(end);
    HalfEdgeId last, h = first;
    std::uint32_t count = 0;
    do {
      if (++count > EdgeStar::kMaxFaces) return false;
      const VertexId second = mesh_.target(h), third = mesh_.apex(h);
      if (second != other && third != other) {
        star_.faces.push_back({at, relative(second), relative(third), is_a});
      }
      last = h;
      h = mesh_.rotate_ccw(h);
    } while (h.valid() && h != first);
    if (h.valid()) return true;
    const VertexId next = mesh_.target(first), previous = mesh_.apex(last);
    if (next != other) star_.borders.push_back({at, relative(next)});
    if (previous != other) star_.borders.push_back({relative(previous), at});
    return true;
  }

  Vec3d relative(VertexId v) const { return scale_ * (work_.position(v) - middle_); }

 private:
  const HalfEdgeMesh& mesh_;
  const WorkingMesh& work_;
  double scale_;
  Vec3d middle_;
  EdgeStar& star_;
};

}  // namespace

void gather_ends(const WorkingMesh& work, HalfEdgeId half_edge, EdgeStar& star) {
  const HalfEdgeMesh& mesh = work.mesh();
  star.half_edge = half_edge;
  star.a = mesh.origin(half_edge);
  star.b = mesh.target(half_edge);
  const Vec3d a = work.position(star.a), b = work.position(star.b);
  star.origin = work.frame().to_unit(0.5 * (a + b));
  const HalfEdgeId twin = mesh.twin(half_edge);
  const Vec3d left = work.position(mesh.apex(half_edge));
  const Vec3d right = twin.valid() ? work.position(mesh.apex(twin)) : Vec3d{};
  static_cast<PlacedEdge&>(star) = place_edge(work.frame(), a, b, left, right, !twin.valid());
  star.a_on_border = mesh.is_border(star.a);
  star.b_on_border = mesh.is_border(star.b);
}

bool gather_star(const WorkingMesh& work, EdgeStar& star) {
  star.faces.clear();
  star.borders.clear();
  FanGatherer fans(work, star);
  if (star.on_border) star.borders.push_back({star.position_a, star.position_b});
  return fans.gather(star.a, true) && fans.gather(star.b, false);
}

bool gather_ring(const WorkingMesh& work, VertexId v, PlacedRing& ring) {
  const HalfEdgeMesh& mesh = work.mesh();
  const Vec3d centre = work.position(v);
  const double scale = work.frame().scale;
  const auto relative = [&](VertexId to) { return scale * (work.position(to) - centre); };
  const HalfEdgeId first = mesh.outgoing(v);
  HalfEdgeId h = first;
  ring.set(0, relative(mesh.target(first)));
  ring.faces = 0;
  do {
    if (ring.faces == OneRing::kMaxFaces) return false;
    ring.set(++ring.faces, relative(mesh.apex(h)));
    h = mesh.rotate_ccw(h);
  } while (h.valid() && h != first);
  ring.finish(ring.faces + 1, !h.valid());
  return true;
}

bool folds_over(const EdgeStar& star, Vec3d position) {
  return std::any_of(star.faces.begin(), star.faces.end(), [&](const EdgeStar::Face& face) {
    return turns(face.end, face.second, face.third, position, 0);
  });
}

}  // namespace pmesh
