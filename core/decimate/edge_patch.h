// What a collapse has changed around the merged vertex: its edges, those of its neighbours, and
// all vertices at either side of them, by one walk around each. Private to core/decimate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/decimate/edge_metric.h"
#include "core/decimate/working_mesh.h"

namespace pmesh {

/// Vertices are numbered: the merged one is 0, its neighbours follow, then theirs. Refers to a
/// mesh, which must outlive it.
class EdgePatch {
 public:
  /// An edge's ends, and the apexes of its faces. As for PlacedEdge, but by number.
  struct Corners {
    std::uint32_t a, b;
    std::uint32_t left;
    std::uint32_t right;  ///< kNoIndex on a border.
  };

  /// Without corners there are only the edges: no corners(), no vertices beyond the neighbours, and
  /// no positions.
  EdgePatch(const WorkingMesh& work, bool with_corners)
      : work_(work), with_corners_(with_corners), numbers_(work.mesh().vertex_slots()) {}

  /// Edges of hubs, vertices of more than OneRing::kMaxFaces faces, are no candidates: they are
  /// left out (but for those that another vertex met first), and around a hub there are none.
  void gather(VertexId merged);

  /// By the lesser of their half-edges, each once; those of the merged vertex first.
  std::span<const HalfEdgeId> edges() const { return edges_; }
  std::span<const HalfEdgeId> merged_edges() const { return edges().first(merged_edges_); }
  std::span<const HalfEdgeId> other_edges() const { return edges().subspan(merged_edges_); }
  std::span<const Corners> corners() const { return corners_; }

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices_.size()); }
  VertexId vertex(std::uint32_t number) const { return vertices_[number]; }
  Vec3d position(std::uint32_t number) const { return positions_[number]; }

 private:
  // An edge, seen from one of its ends.
  struct Spoke {
    VertexId to;
    HalfEdgeId edge;  // the lesser of its half-edges
    bool leaves;      // `edge` leads to `to`, not from it
  };

  bool gather_spokes(VertexId v);
  std::uint32_t number_of(VertexId v) const;  // kNoIndex if it has none
  std::uint32_t number(VertexId v);
  void place_vertices();
  void prefetch_rings(std::uint32_t first);
  void add_edges(std::uint32_t centre);
  void add_corners(std::uint32_t centre, std::size_t i);

  const WorkingMesh& work_;
  bool with_corners_;
  std::vector<std::uint32_t> numbers_;  // by vertex: its number, if vertices_ says so, too
  std::vector<VertexId> vertices_;
  std::vector<Vec3d> positions_;
  std::vector<HalfEdgeId> edges_;
  std::vector<Corners> corners_;
  std::size_t merged_edges_ = 0;
  std::vector<HalfEdgeId> ahead_;  // of prefetch_rings()
  // Of the vertex that is being walked around.
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> ring_;
};

}  // namespace pmesh
