#include "core/decimate/edge_patch.h"

namespace pmesh {

void EdgePatch::gather(VertexId merged) {
  vertices_.clear();
  positions_.clear();
  edges_.clear();
  corners_.clear();
  number(merged);
  add_edges(0);
  merged_edges_ = edges_.size();
  if (edges_.empty()) return;
  const std::uint32_t inner = vertex_count();
  for (std::uint32_t v = 1; v < inner; ++v) add_edges(v);
  if (!with_corners_) return;
  place_vertices();
  prefetch_rings(inner);
}

void EdgePatch::place_vertices() {
  for (const VertexId v : vertices_) positions_.push_back(work_.position(v));
}

// The rings of the vertices from number `first` on will be walked around next. In a large mesh they
// lie far apart in memory: this asks for the greater part of them, of all in step.
void EdgePatch::prefetch_rings(std::uint32_t first) {
  constexpr int kSteps = 3;
  const HalfEdgeMesh& mesh = work_.mesh();
  ahead_.clear();
  for (std::uint32_t v = first; v < vertex_count(); ++v) {
    ahead_.push_back(mesh.outgoing(vertices_[v]));
    mesh.prefetch(ahead_.back());
  }
  for (int step = 0; step < kSteps; ++step) {
    for (HalfEdgeId& h : ahead_) {
      if (!h.valid()) continue;
      work_.prefetch(mesh.apex(h));
      h = mesh.rotate_ccw(h);
      if (h.valid()) mesh.prefetch(h);
    }
  }
}

std::uint32_t EdgePatch::number_of(VertexId v) const {
  const std::uint32_t number = numbers_[v.value];
  return number < vertices_.size() && vertices_[number] == v ? number : kNoIndex;
}

std::uint32_t EdgePatch::number(VertexId v) {
  if (const std::uint32_t known = number_of(v); known != kNoIndex) return known;
  vertices_.push_back(v);
  work_.prefetch(v);
  return numbers_[v.value] = vertex_count() - 1;
}

// Ccw; around a border vertex from end to end. False if `v` is a hub; the walk stops there.
bool EdgePatch::gather_spokes(VertexId v) {
  const HalfEdgeMesh& mesh = work_.mesh();
  const HalfEdgeId first = mesh.outgoing(v);
  spokes_.clear();
  spokes_.push_back({mesh.target(first), first, true});
  HalfEdgeId h = first;
  while (spokes_.size() <= OneRing::kMaxFaces) {
    const HalfEdgeId incoming = HalfEdgeMesh::prev(h);
    h = mesh.twin(incoming);
    if (h == first) {
      if (incoming < first) spokes_.front() = {spokes_.front().to, incoming, false};
      return true;
    }
    const bool leaves = h < incoming;  // an invalid id is the greatest
    spokes_.push_back({mesh.origin(incoming), leaves ? h : incoming, leaves});
    if (!h.valid()) return true;
  }
  return false;
}

// The edges of vertex `centre` but for those that an earlier one had.
void EdgePatch::add_edges(std::uint32_t centre) {
  if (!gather_spokes(vertices_[centre])) return;
  ring_.clear();
  for (const Spoke& spoke : spokes_) {
    ring_.push_back(centre == 0 || with_corners_ ? number(spoke.to) : number_of(spoke.to));
  }
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    if (ring_[i] < centre) continue;
    edges_.push_back(spokes_[i].edge);
    if (with_corners_) add_corners(centre, i);
  }
}

// Of the edge to the ring's vertex `i`.
void EdgePatch::add_corners(std::uint32_t centre, std::size_t i) {
  const bool border = work_.mesh().is_border(vertices_[centre]);
  const std::uint32_t before_first = border ? kNoIndex : ring_.back();
  const std::uint32_t after_last = border ? kNoIndex : ring_.front();
  const std::uint32_t right = i > 0 ? ring_[i - 1] : before_first;
  const std::uint32_t left = i + 1 < ring_.size() ? ring_[i + 1] : after_last;
  corners_.push_back(spokes_[i].leaves ? Corners{centre, ring_[i], left, right}
                                       : Corners{ring_[i], centre, right, left});
}

}  // namespace pmesh
