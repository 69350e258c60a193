// How far apart the two surfaces are that a collapse exchanges: the faces around the vertices that
// it merges, and those around the merged vertex.
//
// Both fill the same link, the polygon around them. Seen along the link's vector area, both cover
// the polygon once, in all but odd cases. Then each point of one has its partner in the other just
// above or below it, and the two are farthest apart where an edge of one crosses an edge of the
// other, or at a vertex that only one of them has: a few points to look at. So what is within e of
// one surface is within e + gap of the other. (For odd cases see core/measure/patch_distance.h.)
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace pmesh {

/// Nothing where a patch does not cover the link once. Keeps its memory from call to call.
///
/// Threads: one at a time.
class CollapseGap {
 public:
  /// Of a collapse that leaves the kept vertex in place. `link` is the removed vertex's link in
  /// order, from the kept vertex on: closed, or, if `on_border`, the path along its faces to its
  /// other neighbour on the border. Precondition: at least two vertices.
  std::optional<double> of_half_edge(Vec3d removed, std::span<const Vec3d> link, bool on_border);

  /// Of a collapse of an edge into a vertex at `merged`. `link` is the edge's, closed and in order:
  /// link[0] to link[first_faces] are neighbours of `first`, link[first_faces] and the rest to
  /// link[0] again are neighbours of `second`. Precondition: 0 < first_faces < link.size().
  std::optional<double> of_edge(Vec3d first, Vec3d second, Vec3d merged,
                                std::span<const Vec3d> link, std::size_t first_faces);

 private:
  // A point seen along the direction: where it is, and how high.
  struct Seen {
    double x, y, z;
  };
  struct Edge {
    Seen a, b;
  };
  struct Face {
    Seen a, b, c;

    double depth(Seen p) const;
    double height_at(Seen p) const;
  };
  // One of the two surfaces: its faces, and the edges and vertices that the other has not.
  struct Patch {
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<Seen> vertices;

    void clear();
    double gap_below(Seen vertex) const;
  };
  class View;

  static double area(Seen a, Seen b, Seen c);
  static double gap_at_crossing(const Edge& e, const Edge& f);
  void see_link(const View& view, std::span<const Vec3d> link);
  void add_fan(Patch& patch, Seen center, std::size_t begin, std::size_t end) const;
  bool is_round(Seen center, bool on_border) const;
  bool cover_once(const View& view, Seen center, bool on_border) const;
  double gap() const;
  double range_of_heights() const;

  std::vector<Seen> link_;  // closed: the first once more at the end
  Patch before_, after_;
};

}  // namespace pmesh
