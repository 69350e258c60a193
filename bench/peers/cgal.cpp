// CGAL's Surface_mesh_simplification: edge collapses by a heap of edges, vertices placed freely.
// Variants: lindstrom-turk (memoryless), garland-heckbert (plane quadrics), and both with +guard,
// the bounded normal change filter (no face may turn by more than 90 degrees).
#define CGAL_EIGEN3_ENABLED
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_policies.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include "bench/peers/runner.h"

namespace pmesh::bench {
namespace {

namespace simplification = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

IndexedMesh to_mesh(const Mesh& mesh) {
  IndexedMesh out;
  std::vector<std::uint32_t> numbers(mesh.num_vertices());
  for (const auto v : mesh.vertices()) {  // skips the removed, as faces() does
    numbers[v] = static_cast<std::uint32_t>(out.positions.size());
    const auto& p = mesh.point(v);
    out.positions.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : mesh.faces()) {
    Triangle& triangle = out.triangles.emplace_back();
    std::size_t corner = 0;
    for (const auto v : vertices_around_face(mesh.halfedge(f), mesh)) {
      triangle[corner++] = numbers[v];
    }
  }
  return out;
}

// Asked before every collapse: stops at a number of faces (CGAL's own predicates count edges) and
// takes the levels of detail on the way.
class StopAtFaces {
 public:
  StopAtFaces(std::uint32_t faces, Lods& lods) : faces_(faces), lods_(lods) {}

  template <class Cost, class Profile>
  bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
    const Mesh& mesh = profile.surface_mesh();
    const auto faces = static_cast<std::uint32_t>(mesh.number_of_faces());
    while (lods_.due(faces)) lods_.take(to_mesh(mesh));
    return faces <= faces_;
  }

 private:
  std::uint32_t faces_;
  Lods& lods_;
};

class Cgal : public Peer {
 public:
  void set_variant(bool quadrics, bool guard) {
    quadrics_ = quadrics;
    guard_ = guard;
  }

  void load(const IndexedMesh& mesh) override {
    for (const Vec3d& p : mesh.positions) mesh_.add_vertex({p.x, p.y, p.z});
    for (const auto& [a, b, c] : mesh.triangles) {
      mesh_.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c));
    }
  }

  void decimate(std::uint32_t faces, Lods& lods) override {
    const StopAtFaces stop(faces, lods);
    if (quadrics_) {
      const simplification::GarlandHeckbert_plane_policies<Mesh, Kernel> policies(mesh_);
      collapse(stop, policies.get_cost(), policies.get_placement());
    } else {
      collapse(stop, simplification::LindstromTurk_cost<Mesh>(),
               simplification::LindstromTurk_placement<Mesh>());
    }
    while (lods.due(static_cast<std::uint32_t>(mesh_.number_of_faces()))) lods.take(to_mesh(mesh_));
  }

 private:
  template <class Cost, class Placement>
  void collapse(const StopAtFaces& stop, const Cost& cost, const Placement& placement) {
    const auto policies = CGAL::parameters::get_cost(cost).get_placement(placement);
    if (guard_) {
      simplification::edge_collapse(
          mesh_, stop, policies.filter(simplification::Bounded_normal_change_filter<>()));
    } else {
      simplification::edge_collapse(mesh_, stop, policies);
    }
  }

  Mesh mesh_;
  bool quadrics_ = false;
  bool guard_ = false;
};

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh::bench;
  Cgal peer;
  return run_peer("cgal", argc, argv, [&](const std::string& variant) -> Peer& {
    const std::string cost = variant.substr(0, variant.find('+'));
    const bool guard = variant == cost + "+guard";
    if ((cost != "lindstrom-turk" && cost != "garland-heckbert") || (!guard && variant != cost)) {
      fail("peer_cgal: the variants are lindstrom-turk, garland-heckbert, and these with +guard");
    }
    peer.set_variant(cost == "garland-heckbert", guard);
    return peer;
  });
}
