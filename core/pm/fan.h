// The fan of faces that a vertex split's new vertex takes over, found once for all who ask about
// it: what it covers, what the patch looks like.
//
// Threads: plain values; no shared state.
#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <span>

#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

class Fan {
 public:
  /// The fan of a split at `site`, which must be possible in `mesh`.
  void walk(const HalfEdgeMesh& mesh, const SplitSite& site) {
    const bool clockwise = site.kind == SplitKind::border_last;
    begin(site.kind, clockwise ? mesh.target(site.half_edge) : mesh.origin(site.half_edge),
          site.moved_faces);
    if (faces_ == 0) {
      half_edges_[0] = site.half_edge;
      return;
    }
    HalfEdgeId h = clockwise ? HalfEdgeMesh::next(site.half_edge) : site.half_edge;
    for (std::uint32_t face = 0;; h = clockwise ? mesh.rotate_cw(h) : mesh.rotate_ccw(h)) {
      half_edges_[face] = h;
      if (++face == faces_) return;
    }
  }

  /// The interior fan of `kept` whose faces' half-edges that leave `kept`, ccw, are `half_edges`.
  /// Precondition: they are at most kMaxMovedFaces, at least one.
  void take(VertexId kept, std::span<const HalfEdgeId> half_edges) {
    assert(!half_edges.empty());
    begin(SplitKind::interior, kept, static_cast<std::uint32_t>(half_edges.size()));
    for (std::uint32_t face = 0; face < faces_; ++face) half_edges_[face] = half_edges[face];
  }

  SplitKind kind() const { return kind_; }
  VertexId kept() const { return kept_; }
  std::uint32_t faces() const { return faces_; }  ///< 0 for an ear.

  /// One a face, in the direction of the kind, each leaving the kept vertex; an ear's is the border
  /// half-edge that it is glued to.
  std::span<const HalfEdgeId> half_edges() const {
    return {half_edges_.data(), faces_ == 0 ? 1 : faces_};
  }

 private:
  void begin(SplitKind kind, VertexId kept, std::uint32_t faces) {
    assert(faces <= kMaxMovedFaces);
    kind_ = kind;
    kept_ = kept;
    faces_ = faces;
  }

  SplitKind kind_ = SplitKind::interior;
  VertexId kept_;
  std::uint32_t faces_ = 0;
  std::array<HalfEdgeId, kMaxMovedFaces> half_edges_;
};

}  // namespace pmesh
