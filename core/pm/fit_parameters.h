// Chooses a batch's parameters: the weights by which its splits' residuals are least.
#pragma once

#include <span>

#include "core/pm/batch_mesh.h"
#include "core/pm/split_model.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// By least squares over the batch, drawn to `before`, the parameters of the batch before it, which
/// stay where a change would cost more bits than it saves. Deterministic; the decoder does not
/// depend on how they were found.
BatchParameters fit_parameters(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                               const BatchParameters& before);

}  // namespace pmesh
