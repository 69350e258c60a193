// Chooses a batch's parameters: the weights with which its splits take the fewest bits. The decoder
// does not depend on how they were found.
//
// Threads: pure functions.
#pragma once

#include <span>

#include "core/pm/batch_mesh.h"
#include "core/pm/split_model.h"
#include "core/refine/refinable_mesh.h"

namespace pmesh {

/// By iteratively reweighted least squares over the batch (all of a small one, a sample of a large
/// one), drawn to `before`, the parameters of the batch before it, which stay where a change would
/// cost more bits than it saves.
Predictor fit_predictor(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                        const Predictor& before);

/// By maximum likelihood, if each fan is chosen among its vertex's candidates with a chance that
/// grows with the exponential of their scores.
FanWeights fit_fan_weights(const RefinableMesh& mesh, std::span<const BatchSplit> batch,
                           const FanWeights& before);

/// What a changed weight costs, about.
inline constexpr double kBitsOfChange = 6;

}  // namespace pmesh
