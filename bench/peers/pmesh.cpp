// pmesh's greedy engine. Variant: a metric of core/metrics/table.h, its parameters after a colon
// (melod:lambda=10). Levels of detail come from the log, not from a PM file: nothing is quantised.
#include <algorithm>
#include <numeric>
#include <utility>

#include "bench/peers/runner.h"
#include "core/decimate/decimate.h"

namespace pmesh::bench {
namespace {

std::vector<Triangle> triangles_of(const HalfEdgeMesh& mesh) {
  std::vector<Triangle> triangles;
  const auto corners = mesh.corners();
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    triangles.push_back({corners[i].value, corners[i + 1].value, corners[i + 2].value});
  }
  return triangles;
}

// The collapses that it takes from a mesh of `faces` faces to the first LOD of at most `target`.
std::size_t collapses_to(std::size_t faces, std::uint32_t target, const CollapseLog& log) {
  std::size_t count = 0;
  while (faces > target && count < log.collapses.size()) {
    for (std::uint32_t k = 0; k < log.collapses_per_step; ++k) {
      faces -= static_cast<std::size_t>(log.collapses[count++].removed_faces());
    }
  }
  return count;
}

// What the first `count` collapses made of `triangles`.
IndexedMesh lod(const std::vector<Triangle>& triangles, const Decimation& decimation,
                std::size_t count) {
  const CollapseLog& log = decimation.log;
  IndexedMesh mesh{decimation.positions, {}};
  for (std::size_t i = log.kept_before.size(); i-- > count;) {
    mesh.positions[log.collapses[i].kept.value] = log.kept_before[i];
  }
  std::vector<std::uint32_t> became(mesh.positions.size());
  std::iota(became.begin(), became.end(), 0);
  for (std::size_t i = count; i-- > 0;) {
    became[log.collapses[i].removed.value] = became[log.collapses[i].kept.value];
  }
  for (const auto& [a, b, c] : triangles) {
    const Triangle t = {became[a], became[b], became[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return without_unused_vertices(mesh);
}

class Pmesh : public Peer {
 public:
  void set_metric(const AnyMetric& metric) { metric_ = metric; }

  void load(const IndexedMesh& mesh) override {
    auto built =
        HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
    if (!built) fail(built.error().message);
    mesh_ = std::move(*built);
    positions_ = mesh.positions;
  }

  void decimate(std::uint32_t faces, Lods& lods) override {
    std::vector<Triangle> triangles;
    if (!lods.levels().empty()) triangles = triangles_of(mesh_);
    DecimateOptions options;
    options.schedule = Schedule::exact;
    options.metric = metric_;
    options.base_faces = faces;
    const Decimation result = pmesh::decimate(std::move(mesh_), std::move(positions_), options);
    for (const Level& level : lods.levels()) {
      lods.take_if_due(
          lod(triangles, result, collapses_to(triangles.size(), level.faces, result.log)));
    }
  }

 private:
  AnyMetric metric_;
  HalfEdgeMesh mesh_;
  std::vector<Vec3d> positions_;
};

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh::bench;
  Pmesh peer;
  return run_peer("pmesh", argc, argv, [&](const std::string& variant) -> Peer& {
    const std::string name = variant.substr(0, variant.find(':'));
    const std::string parameters = variant.substr(std::min(variant.size(), name.size() + 1));
    const auto metric = pmesh::make_metric(name, parameters);
    if (!metric) fail(metric.error().message);
    peer.set_metric(*metric);
    return peer;
  });
}
