// Brings the one-ring of the vertex that will probably be removed next into the processor's caches
// while the one before is being dealt with. In a large mesh the greedy order jumps about: without
// this a quarter of the time goes by in waiting for memory. Private to core/decimate.
#pragma once

#include "core/decimate/working_mesh.h"

namespace pmesh {

/// Refers to a mesh, which must outlive it, and which may be edited between any two calls.
class RingAhead {
 public:
  explicit RingAhead(const WorkingMesh& work) : work_(work) {}

  /// Begins with live vertex `v`, and leaves the one before.
  void start(VertexId v) {
    vertex_ = v;
    at_ = HalfEdgeId();
    work_.prefetch(v);
  }

  /// Goes on to the next neighbour. Each step reads what the one before has asked for, so there
  /// should be some work between two.
  void step() {
    const HalfEdgeMesh& mesh = work_.mesh();
    if (!at_.valid()) {
      if (!vertex_.valid() || !mesh.is_live(vertex_)) return;
      first_ = at_ = mesh.outgoing(vertex_);
    } else {
      if (!mesh.is_live(HalfEdgeMesh::face(at_))) return;
      work_.prefetch(mesh.target(at_));
      at_ = mesh.rotate_ccw(at_);
      if (!at_.valid() || at_ == first_) {
        at_ = HalfEdgeId();
        vertex_ = VertexId();
        return;
      }
    }
    mesh.prefetch(at_);
  }

 private:
  const WorkingMesh& work_;
  VertexId vertex_;        // invalid once it has been walked around
  HalfEdgeId first_, at_;  // at_: invalid before the walk
};

}  // namespace pmesh
