#include "core/io/edge_matching.h"

#include <utility>

#include "core/io/repeats.h"
#include "core/mesh/edge_groups.h"
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {
namespace {

class Matcher {
 public:
  Matcher(std::span<const Triangle> triangles, std::uint32_t vertex_count)
      : triangles_(triangles), opposites_(find_opposites(triangles)) {
    result_.twins.resize(3 * triangles.size());
    result_.touched.resize(vertex_count);
  }

  void note_pairs() {
    for (std::uint32_t f = 0; f < opposites_.size(); ++f) {
      if (!opposites_[f].valid()) continue;
      for (const std::uint32_t v : triangles_[f]) result_.touched[v] = true;
      if (f < opposites_[f].value) ++result_.opposite_pairs;
    }
  }

  void match(std::span<const EdgeSide> sides) {
    if (sides.size() == 1) return;
    if (!match_if_unambiguous(sides)) cut(sides);
  }

  EdgeMatching take_result() { return std::move(result_); }

 private:
  std::uint32_t origin(HalfEdgeId h) const { return triangles_[h.value / 3][h.value % 3]; }
  bool are_opposite(HalfEdgeId a, HalfEdgeId b) const {
    return opposites_[HalfEdgeMesh::face(a).value] == HalfEdgeMesh::face(b);
  }

  bool match_if_unambiguous(std::span<const EdgeSide> sides) {
    // With five half-edges, three of them run one way: each of the others fits two or more.
    if (sides.size() > 4) return false;
    bool has_both_directions = false;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t j = i + 1; j < sides.size(); ++j) {
        const HalfEdgeId a(sides[i].half_edge), b(sides[j].half_edge);
        if (origin(a) == origin(b)) continue;
        has_both_directions = true;
        if (are_opposite(a, b)) continue;
        if (twin(a).valid() || twin(b).valid()) return false;
        twin(a) = b;
        twin(b) = a;
      }
    }
    return has_both_directions;
  }

  void cut(std::span<const EdgeSide> sides) {
    for (const EdgeSide& side : sides) twin(HalfEdgeId(side.half_edge)) = HalfEdgeId();
    const HalfEdgeId h(sides[0].half_edge);
    result_.touched[origin(h)] = true;
    result_.touched[origin(HalfEdgeMesh::next(h))] = true;
    ++(sides.size() == 2 ? result_.winding_edges_cut : result_.nonmanifold_edges_cut);
  }

  HalfEdgeId& twin(HalfEdgeId h) { return result_.twins[h.value]; }

  std::span<const Triangle> triangles_;
  std::vector<FaceId> opposites_;
  EdgeMatching result_;
};

}  // namespace

EdgeMatching match_edges(std::span<const Triangle> triangles, std::uint32_t vertex_count) {
  Matcher matcher(triangles, vertex_count);
  matcher.note_pairs();
  for_each_edge(triangles, vertex_count,
                [&](std::span<const EdgeSide> sides) { matcher.match(sides); });
  return matcher.take_result();
}

}  // namespace pmesh
