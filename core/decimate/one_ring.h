// Gathers the geometry that metrics and the fold-over check read (see metric.h).
#pragma once

#include <span>

#include "core/decimate/border_loops.h"
#include "core/decimate/metric.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

/// A face whose doubled area is at most this times its squared longest edge (within a factor of
/// four) has no usable normal: it counts as a face without area.
inline constexpr double kZeroAreaRatio = 1e-10;

/// One over the diagonal of the bounding box of `positions`; 1 if that is not a positive number.
double unit_scale(std::span<const Vec3d> positions);

/// Fills ring.centre, neighbours, faces, border and ids. False if `v` has more than
/// OneRing::kMaxFaces faces; the walk stops there.
bool gather_neighbours(const HalfEdgeMesh& mesh, VertexId v, OneRing& ring);

/// Fills in the geometry, after gather_neighbours. `scale` is the whole mesh's unit_scale.
void gather_geometry(std::span<const Vec3d> positions, double scale, const BorderLoops& borders,
                     OneRing& ring);

/// The faces that move if the centre is collapsed into neighbour `head`, on a border along a
/// border edge. Precondition: head is the first or last neighbour if ring.border.
void move_faces(const OneRing& ring, std::uint32_t head, MovedFaces& moved);

}  // namespace pmesh
