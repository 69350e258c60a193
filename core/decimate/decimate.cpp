#include "core/decimate/decimate.h"

#include "core/decimate/batch_engine.h"
#include "core/decimate/edge_candidates.h"
#include "core/decimate/engine.h"
#include "core/decimate/half_edge_candidates.h"
#include "core/decimate/triangle_candidates.h"

namespace pmesh {
namespace {

template <HalfEdgeMetric M>
HalfEdgeCandidates<M> make_candidates(WorkingMesh& work, const M& metric,
                                      const DecimateOptions& options) {
  return {work, metric, options};
}

template <EdgeMetric M>
EdgeCandidates<M> make_candidates(WorkingMesh& work, const M& metric,
                                  const DecimateOptions& options) {
  return {work, metric, options.locked};
}

template <TriangleMetric M>
TriangleCandidates<M> make_candidates(WorkingMesh& work, const M& metric,
                                      const DecimateOptions& options) {
  return {work, metric, options.locked};
}

}  // namespace

Decimation decimate(HalfEdgeMesh mesh, std::vector<Vec3d> positions,
                    const DecimateOptions& options) {
  assert(options.threads >= 1);
  assert(options.locked.empty() || options.locked.size() == positions.size());
  WorkingMesh work(std::move(mesh), std::move(positions));
  std::uint32_t collapses_per_step = 1;
  const DecimationReport report = std::visit(
      [&](const auto& metric) {
        auto candidates = make_candidates(work, metric, options);
        collapses_per_step = candidates.kCollapsesPerStep;
        if (options.schedule == Schedule::exact) return Engine(work, candidates, options).run();
        return BatchEngine(work, candidates, options).run();
      },
      options.metric);
  Decimation result{work.take_mesh(), work.take_log(), work.take_positions(), report};
  result.log.collapses_per_step = collapses_per_step;
  return result;
}

}  // namespace pmesh
