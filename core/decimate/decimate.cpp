#include "core/decimate/decimate.h"

#include "core/decimate/engine.h"

namespace pmesh {

Decimation decimate(HalfEdgeMesh mesh, std::span<const Vec3d> positions,
                    const DecimateOptions& options) {
  return std::visit(
      [&](const auto& metric) { return Engine(std::move(mesh), positions, metric, options).run(); },
      options.metric);
}

}  // namespace pmesh
