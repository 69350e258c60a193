#include "core/decimate/legality.h"

namespace pmesh {
namespace {

// A kept vertex with more faces is looked up from its neighbours' side instead of being walked.
constexpr std::uint32_t kShortWalk = 32;

struct KeptRing {
  std::uint32_t faces = 0;
  std::uint32_t common = 0;  // neighbours that it shares with the removed vertex
  bool closed = false;
};

// Whole blocks are compared, without a branch in them.
bool contains(const OneRing& ring, VertexId v) {
  constexpr std::uint32_t kBlock = OneRing::kIdBlock;
  bool found = false;
  for (std::uint32_t first = 0; first < ring.neighbours; first += kBlock) {
    std::uint32_t equal = 0;
    for (std::uint32_t i = first; i < first + kBlock; ++i) equal |= ring.ids[i] == v ? 1 : 0;
    found |= equal != 0;
  }
  return found;
}

KeptRing look_up_neighbours(const HalfEdgeMesh& mesh, const OneRing& ring, VertexId kept) {
  KeptRing found;
  found.faces = kShortWalk + 1;
  for (std::uint32_t i = 0; i < ring.neighbours; ++i) {
    const VertexId x = ring.ids[i];
    found.common += x != kept && mesh.find_edge(kept, x).valid();
  }
  return found;
}

KeptRing walk_kept_ring(const HalfEdgeMesh& mesh, const OneRing& ring, VertexId kept) {
  KeptRing found;
  const HalfEdgeId first = mesh.outgoing(kept);
  HalfEdgeId last, h = first;
  do {
    if (found.faces == kShortWalk) return look_up_neighbours(mesh, ring, kept);
    found.common += contains(ring, mesh.target(h));
    ++found.faces;
    last = h;
    h = mesh.rotate_ccw(h);
  } while (h.valid() && h != first);
  found.closed = h.valid();
  if (!found.closed) found.common += contains(ring, mesh.apex(last));
  return found;
}

}  // namespace

bool link_condition_holds(const HalfEdgeMesh& mesh, const OneRing& ring, std::uint32_t head) {
  const KeptRing kept = walk_kept_ring(mesh, ring, ring.ids[head]);
  if (ring.border) {
    const bool is_triangle = ring.faces == 1 && kept.faces == 1;
    return kept.common == 1 && !is_triangle;
  }
  const bool is_tetrahedron = ring.faces == 3 && kept.faces == 3 && kept.closed;
  return kept.common == 2 && !is_tetrahedron;
}

}  // namespace pmesh
