// meshoptimizer: sweeps of edge collapses with quadrics, vertices stay a subset. Not progressive:
// each level is a run of its own. Variant: simplify.
#include <cfloat>
#include <vector>

#include <meshoptimizer.h>

#include "bench/peers/runner.h"

namespace pmesh::bench {
namespace {

class Meshoptimizer : public Peer {
 public:
  void load(const IndexedMesh& mesh) override {
    positions_.reserve(3 * mesh.positions.size());
    for (const Vec3d& p : mesh.positions) {
      for (const double x : {p.x, p.y, p.z}) positions_.push_back(static_cast<float>(x));
    }
    indices_.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) indices_.insert(indices_.end(), t.begin(), t.end());
  }

  void decimate(std::uint32_t faces, Lods& lods) override {
    if (lods.levels().empty()) simplify(faces);
    for (const Level& level : lods.levels()) lods.take_if_due(to_mesh(simplify(level.faces)));
  }

 private:
  std::vector<unsigned> simplify(std::uint32_t faces) const {
    std::vector<unsigned> simplified(indices_.size());
    simplified.resize(meshopt_simplify(simplified.data(), indices_.data(), indices_.size(),
                                       positions_.data(), positions_.size() / 3, 3 * sizeof(float),
                                       3 * std::size_t{faces}, FLT_MAX, 0, nullptr));
    return simplified;
  }

  IndexedMesh to_mesh(const std::vector<unsigned>& indices) const {
    IndexedMesh mesh;
    for (std::size_t i = 0; i < positions_.size(); i += 3) {
      mesh.positions.push_back({positions_[i], positions_[i + 1], positions_[i + 2]});
    }
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return without_unused_vertices(mesh);
  }

  std::vector<float> positions_;
  std::vector<unsigned> indices_;
};

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh::bench;
  Meshoptimizer peer;
  return run_peer("meshoptimizer", argc, argv, [&](const std::string& variant) -> Peer& {
    if (variant != "simplify") fail("peer_meshoptimizer: the variant is simplify");
    return peer;
  });
}
