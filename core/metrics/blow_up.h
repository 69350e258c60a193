// Blow-up weights: how many points of feature-sensitive space the creases and corners of a mesh
// stand for (section 4.1 of the paper that feature_sensitive.h names; equations 9 and 10).
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/decimate/metric_frame.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// An edge is sharp if its faces' normals differ by more (theta_E).
inline constexpr double kSharpAngle = std::numbers::pi / 4;
/// A vertex is a cone if its faces' angles add up to less than 2 pi times this angle's cosine
/// (theta_C).
inline constexpr double kConeAngle = std::numbers::pi / 12;
/// A crease has one more point for each beginning multiple of this angle (theta_t; the paper leaves
/// it to the user). No common angle of machine parts is a multiple, so that rounding decides
/// nothing, and a right angle has three points, as many as the paper finds at most vertices.
inline constexpr double kAngleStep = std::numbers::pi / 3;

/// By vertex: 1 on smooth surface, ceil(theta / theta_t) + 1 on a crease that turns by theta, one
/// more than its neighbours' sum at a corner (where three sharp edges meet, or a cone). Between two
/// corners a point of their edge is the neighbour of both.
std::vector<double> blow_up_weights(const HalfEdgeMesh& mesh, std::span<const Vec3d> positions,
                                    const MetricFrame& frame);

}  // namespace pmesh
