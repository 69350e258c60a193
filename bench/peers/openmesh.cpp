// OpenMesh: half-edge collapses by a heap of vertices and quadrics, vertices stay a subset.
// Variants: quadric, quadric+guard (no face may turn by more than 90 degrees).
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "bench/peers/runner.h"

namespace pmesh::bench {
namespace {

using Mesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Decimater = OpenMesh::Decimater::DecimaterT<Mesh>;

IndexedMesh to_mesh(const Mesh& mesh) {
  IndexedMesh out;
  std::vector<std::uint32_t> numbers(mesh.n_vertices());
  for (const auto v : mesh.vertices()) {  // skips the deleted, as faces() and fv_range() do
    numbers[static_cast<std::size_t>(v.idx())] = static_cast<std::uint32_t>(out.positions.size());
    const auto& p = mesh.point(v);
    out.positions.push_back({p[0], p[1], p[2]});
  }
  for (const auto f : mesh.faces()) {
    Triangle& triangle = out.triangles.emplace_back();
    std::size_t corner = 0;
    for (const auto v : mesh.fv_range(f)) {
      triangle[corner++] = numbers[static_cast<std::size_t>(v.idx())];
    }
  }
  return out;
}

// Sees every collapse, has no say in it, and takes the levels of detail on the way.
template <class MeshT>
class ModLods : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(ModLods, MeshT, Lods);

  explicit ModLods(MeshT& mesh) : Base(mesh, true), faces_(mesh.n_faces()) {}

  void set_lods(Lods& lods) { lods_ = &lods; }

  void postprocess_collapse(const CollapseInfo& collapse) override {
    faces_ -= std::size_t{collapse.fl.is_valid()} + std::size_t{collapse.fr.is_valid()};
    while (lods_->due(static_cast<std::uint32_t>(faces_))) lods_->take(to_mesh(Base::mesh()));
  }

 private:
  std::size_t faces_;
  Lods* lods_ = nullptr;
};

class OpenMeshPeer : public Peer {
 public:
  void set_guard(bool guard) { guard_ = guard; }

  void load(const IndexedMesh& mesh) override {
    std::vector<Mesh::VertexHandle> handles;
    for (const Vec3d& p : mesh.positions) {
      handles.push_back(mesh_.add_vertex(
          Mesh::Point(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z))));
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      mesh_.add_face(handles[a], handles[b], handles[c]);
    }
    mesh_.request_vertex_status();
    mesh_.request_edge_status();
    mesh_.request_face_status();
    mesh_.request_face_normals();
  }

  void decimate(std::uint32_t faces, Lods& lods) override {
    mesh_.update_face_normals();
    Decimater decimater(mesh_);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle guard;
    ModLods<Mesh>::Handle watcher;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    if (guard_) decimater.add(guard);
    if (!lods.levels().empty()) {
      decimater.add(watcher);
      decimater.module(watcher).set_lods(lods);
    }
    if (!decimater.initialize()) fail("peer_openmesh: the decimater did not initialise");
    decimater.decimate_to_faces(0, faces);
  }

 private:
  Mesh mesh_;
  bool guard_ = false;
};

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh::bench;
  OpenMeshPeer peer;
  return run_peer("openmesh", argc, argv, [&](const std::string& variant) -> Peer& {
    if (variant != "quadric" && variant != "quadric+guard") {
      fail("peer_openmesh: the variants are quadric and quadric+guard");
    }
    peer.set_guard(variant == "quadric+guard");
    return peer;
  });
}
