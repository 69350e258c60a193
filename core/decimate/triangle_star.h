// Gathers the geometry that metrics of triangles and the engine's tests read (see
// triangle_metric.h).
#pragma once

#include "core/decimate/triangle_metric.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// Fills in corners, positions and apexes. False if a corner lies on a border.
bool gather_triangle(const WorkingMesh& work, FaceId face, TriangleStar& star);

/// Fills in the rest. False if a corner has more than TriangleStar::kMaxFaces faces; the walk stops
/// there.
bool gather_star(const WorkingMesh& work, TriangleStar& star);

/// Whether both half-edge collapses keep the link condition (see legality.h), each in its turn.
bool link_conditions_hold(const TriangleStar& star);

/// Whether the collapse of `face` leaves an apex with three faces. Next to such a vertex little can
/// be collapsed: where every triangle of a coarse mesh has one in its middle, nothing can.
bool leaves_valence_three(const HalfEdgeMesh& mesh, FaceId face);

/// Whether a surviving face turns by more than the angle of `least_cosine`, or loses its area.
bool turns_faces(const TriangleStar& star, double least_cosine);

}  // namespace pmesh
