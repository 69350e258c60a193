#include "core/metrics/blow_up.h"

#include <algorithm>
#include <cmath>

namespace pmesh {
namespace {

double angle(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// Equation 9.
double crease_weight(double theta) { return std::ceil(theta / kAngleStep) + 1; }

class BlowUp {
 public:
  BlowUp(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions, const MetricFrame& frame)
      : mesh_(mesh), positions_(positions), frame_(frame), vertices_(mesh.vertex_slots()) {
    for_each_edge([&](HalfEdgeId h, VertexId a, VertexId b) { note_edge(turn(h), a, b); });
    for_each_half_edge([&](HalfEdgeId h) { vertices_[mesh_.origin(h).value].angles += corner(h); });
  }

  std::vector<double> weights() const {
    std::vector<double> weights(vertices_.size());
    for (std::uint32_t v = 0; v < weights.size(); ++v) weights[v] = is_corner(v) ? 1 : simple(v);
    for_each_edge([&](HalfEdgeId h, VertexId a, VertexId b) {
      // Equation 10, with a point between two corners.
      const bool both = is_corner(a.value) && is_corner(b.value);
      const double between = both ? crease_weight(turn(h)) : 0;
      if (is_corner(a.value)) weights[a.value] += both ? between : weights[b.value];
      if (is_corner(b.value)) weights[b.value] += both ? between : weights[a.value];
    });
    return weights;
  }

 private:
  struct Vertex {
    int sharp_edges = 0;
    double sharpest = 0;  // radians
    double angles = 0;    // of its faces
  };

  template <class Visit>
  void for_each_half_edge(const Visit& visit) const {
    for (std::uint32_t h = 0; h < 3 * mesh_.face_slots(); ++h) {
      if (mesh_.is_live(HalfEdgeMesh::face(HalfEdgeId(h)))) visit(HalfEdgeId(h));
    }
  }

  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for_each_half_edge([&](HalfEdgeId h) {
      const HalfEdgeId twin = mesh_.twin(h);
      if (!twin.valid() || h < twin) visit(h, mesh_.origin(h), mesh_.target(h));
    });
  }

  Vec3d at(VertexId v) const { return frame_.to_unit(positions_[v.value]); }

  Vec3d doubled_area(HalfEdgeId h) const {
    const Vec3d origin = at(mesh_.origin(h));
    return cross(at(mesh_.target(h)) - origin, at(mesh_.apex(h)) - origin);
  }

  // By how much the surface turns at an edge; 0 at a border and beside faces without area.
  double turn(HalfEdgeId h) const {
    const HalfEdgeId twin = mesh_.twin(h);
    return twin.valid() ? angle(doubled_area(h), doubled_area(twin)) : 0;
  }

  double corner(HalfEdgeId h) const {
    const Vec3d origin = at(mesh_.origin(h));
    return angle(at(mesh_.target(h)) - origin, at(mesh_.apex(h)) - origin);
  }

  void note_edge(double theta, VertexId a, VertexId b) {
    if (!(theta > kSharpAngle)) return;
    for (const VertexId v : {a, b}) {
      Vertex& vertex = vertices_[v.value];
      ++vertex.sharp_edges;
      vertex.sharpest = std::max(vertex.sharpest, theta);
    }
  }

  bool is_corner(std::uint32_t v) const {
    if (vertices_[v].sharp_edges >= 3) return true;
    if (!mesh_.is_live(VertexId(v)) || mesh_.is_border(VertexId(v))) return false;
    return vertices_[v].angles < 2 * std::numbers::pi * std::cos(kConeAngle);
  }

  // Of a vertex that is no corner.
  double simple(std::uint32_t v) const {
    return vertices_[v].sharp_edges > 0 ? crease_weight(vertices_[v].sharpest) : 1;
  }

  const HalfEdgeMesh& mesh_;
  std::span<const Vec3d> positions_;
  const MetricFrame& frame_;
  std::vector<Vertex> vertices_;
};

}  // namespace

std::vector<double> blow_up_weights(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions,
                                    const MetricFrame& frame) {
  return BlowUp(mesh, positions, frame).weights();
}

}  // namespace pmesh
