// HalfEdgeMesh's edits: collapse, split and append with their undoing, and the search for the site
// that inverts a collapse. Names as in half_edge_mesh.h's picture.
#include "core/mesh/half_edge_mesh.h"

namespace pmesh {

void HalfEdgeMesh::reserve(std::uint32_t vertices, std::uint32_t faces) {
  origins_.reserve(std::size_t{3} * faces);
  twins_.reserve(std::size_t{3} * faces);
  outgoing_.reserve(vertices);
}

void HalfEdgeMesh::set_twins(HalfEdgeId a, HalfEdgeId b) {
  if (a.valid()) twins_[a.value] = b;
  if (b.valid()) twins_[b.value] = a;
}

void HalfEdgeMesh::kill_face(FaceId f) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    origins_[3 * f.value + k] = VertexId();
    twins_[3 * f.value + k] = HalfEdgeId();
  }
}

FaceId HalfEdgeMesh::append_face(VertexId a, VertexId b, VertexId c) {
  const FaceId f(face_slots());
  origins_.insert(origins_.end(), {a, b, c});
  twins_.insert(twins_.end(), 3, HalfEdgeId());
  ++live_faces_;
  return f;
}

HalfEdgeId HalfEdgeMesh::find_edge(VertexId a, VertexId b) const {
  // Both rings are walked in step, so that a hub of high valence costs no more than its neighbour.
  // A border half-edge is the first of its origin's ring, so the targets are all the neighbours.
  const HalfEdgeId first_a = outgoing(a), first_b = outgoing(b);
  HalfEdgeId from_a = first_a, from_b = first_b;
  while (true) {
    if (target(from_a) == b) return from_a;
    if (target(from_b) == a) return twin(from_b).valid() ? twin(from_b) : from_b;
    from_a = rotate_ccw(from_a);
    from_b = rotate_ccw(from_b);
    if (!from_a.valid() || from_a == first_a || !from_b.valid() || from_b == first_b) return {};
  }
}

HalfEdgeCollapse HalfEdgeMesh::collapse_uncounted(VertexId removed, HalfEdgeId edge) {
  const bool leaves_removed = origin(edge) == removed;
  assert(leaves_removed || target(edge) == removed);
  const HalfEdgeId to_kept = leaves_removed ? edge : twin(edge);
  const HalfEdgeId to_removed = leaves_removed ? twin(edge) : edge;
  assert(!is_border(removed) || !to_kept.valid() || !to_removed.valid());

  HalfEdgeCollapse done{removed, leaves_removed ? target(edge) : origin(edge), {}, {}};
  const HalfEdgeId first = outgoing(removed);
  HalfEdgeId& anchor = outgoing_[done.kept.value];
  HalfEdgeId h = first;
  do {  // faces L and R too: they die below
    origins_[h.value] = done.kept;
    h = rotate_ccw(h);
  } while (h.valid() && h != first);

  if (to_kept.valid()) {  // L = (removed, kept, left)
    const HalfEdgeId kept_to_left = next(to_kept), left_to_removed = prev(to_kept);
    const HalfEdgeId outer = twin(kept_to_left), inner = twin(left_to_removed);
    done.left = origin(left_to_removed);
    set_twins(outer, inner);
    if (outgoing(done.left) == left_to_removed) outgoing_[done.left.value] = outer;
    if (anchor == kept_to_left || anchor == to_removed) anchor = inner;
  }
  if (to_removed.valid()) {  // R = (kept, removed, right)
    const HalfEdgeId removed_to_right = next(to_removed), right_to_kept = prev(to_removed);
    const HalfEdgeId inner = twin(removed_to_right), outer = twin(right_to_kept);
    done.right = origin(right_to_kept);
    set_twins(outer, inner);
    if (outgoing(done.right) == right_to_kept) outgoing_[done.right.value] = inner;
    // On a border, kept's fan now begins where removed's did.
    if (!to_kept.valid()) anchor = first == removed_to_right ? outer : first;
  }
  if (to_kept.valid()) kill_face(face(to_kept));
  if (to_removed.valid()) kill_face(face(to_removed));
  outgoing_[removed.value] = HalfEdgeId();
  return done;
}

Status HalfEdgeMesh::check(const SplitSite& site) const {
  const HalfEdgeId start = site.half_edge;
  if (start.value >= origins_.size()) return bad_input("the split's half-edge does not exist");
  if (live_faces_ > kNoIndex / 3 - 2) return bad_input("too many faces for 32-bit ids");
  if (site.kind == SplitKind::interior) {
    if (site.moved_faces == 0) return bad_input("an interior split moves no face");
  } else {
    if (!is_border(start)) return bad_input("a border split is not at a border");
    if (site.moved_faces == 0) return {};
  }
  const bool clockwise = site.kind == SplitKind::border_last;
  HalfEdgeId h = clockwise ? next(start) : start;
  for (std::uint32_t moved = 1; moved < site.moved_faces; ++moved) {
    h = clockwise ? rotate_cw(h) : rotate_ccw(h);
    if (!h.valid() || h == start) return bad_input("the split moves more faces than there are");
  }
  if (site.kind == SplitKind::interior && rotate_ccw(h) == start) {
    return bad_input("the split's cut neighbours are the same");
  }
  return {};
}

// The border of a moved fan, before it moves: its first face has kept -> left (inner_left), its
// last has right -> kept (inner_right); outer_* are their twins. A fan without faces has the border
// half-edge itself as its outer side.
struct HalfEdgeMesh::MovedFan {
  VertexId kept;
  HalfEdgeId inner_left, outer_left;
  HalfEdgeId inner_right, outer_right;
};

HalfEdgeMesh::MovedFan HalfEdgeMesh::move_fan(const SplitSite& site, VertexId added) {
  MovedFan fan;
  HalfEdgeId h = site.half_edge;
  if (site.kind == SplitKind::border_last) {
    fan.kept = target(h);
    fan.outer_left = h;
    for (std::uint32_t moved = 0; moved < site.moved_faces; ++moved) {
      fan.inner_left = next(fan.outer_left);
      fan.outer_left = twin(fan.inner_left);
      origins_[fan.inner_left.value] = added;
    }
    return fan;
  }
  fan.kept = origin(h);
  fan.outer_right = h;
  if (site.kind == SplitKind::interior) {
    fan.inner_left = h;
    fan.outer_left = twin(h);
  }
  for (std::uint32_t moved = 0; moved < site.moved_faces; ++moved) {
    fan.inner_right = prev(fan.outer_right);
    origins_[fan.outer_right.value] = added;
    fan.outer_right = twin(fan.inner_right);
  }
  return fan;
}

HalfEdgeId HalfEdgeMesh::append_left(const MovedFan& fan, VertexId added) {
  const VertexId left = fan.inner_left.valid() ? target(fan.inner_left) : origin(fan.outer_left);
  const HalfEdgeId added_to_kept(3 * append_face(added, fan.kept, left).value);
  const HalfEdgeId kept_to_left = next(added_to_kept), left_to_added = prev(added_to_kept);
  set_twins(kept_to_left, fan.outer_left);
  set_twins(left_to_added, fan.inner_left);
  if (!fan.inner_left.valid()) outgoing_[left.value] = left_to_added;
  HalfEdgeId& anchor = outgoing_[fan.kept.value];
  if (origin(anchor) == added) anchor = kept_to_left;
  return added_to_kept;
}

HalfEdgeId HalfEdgeMesh::append_right(const MovedFan& fan, VertexId added) {
  const VertexId right =
      fan.inner_right.valid() ? origin(fan.inner_right) : target(fan.outer_right);
  const HalfEdgeId added_to_right(3 * append_face(added, right, fan.kept).value);
  const HalfEdgeId right_to_kept = next(added_to_right);
  set_twins(added_to_right, fan.inner_right);
  set_twins(right_to_kept, fan.outer_right);
  if (!fan.outer_right.valid()) outgoing_[right.value] = right_to_kept;
  return prev(added_to_right);  // kept -> added
}

VertexId HalfEdgeMesh::split(const SplitSite& site) {
  const VertexId added(vertex_slots());
  outgoing_.emplace_back();
  ++live_vertices_;
  const MovedFan fan = move_fan(site, added);
  switch (site.kind) {
    case SplitKind::interior: {
      const HalfEdgeId added_to_kept = append_left(fan, added);
      set_twins(added_to_kept, append_right(fan, added));
      outgoing_[added.value] = fan.inner_left;
      break;
    }
    case SplitKind::border_first: {
      const HalfEdgeId kept_to_added = append_right(fan, added);
      outgoing_[added.value] = site.moved_faces > 0 ? site.half_edge : next(kept_to_added);
      outgoing_[fan.kept.value] = kept_to_added;
      break;
    }
    case SplitKind::border_last:
      outgoing_[added.value] = append_left(fan, added);
      break;
  }
  return fan.kept;
}

void HalfEdgeMesh::undo_split(const SplitSite& site) {
  const std::uint32_t faces = face_slots();
  const HalfEdgeId edge =
      site.kind == SplitKind::border_first
          ? HalfEdgeId(3 * (faces - 1) + 2)  // kept -> added, in R
          : HalfEdgeId(3 * (faces - static_cast<std::uint32_t>(site.added_faces())));  // in L
  collapse(VertexId(vertex_slots() - 1), edge);
  outgoing_.pop_back();
  origins_.resize(origins_.size() - 3 * static_cast<std::size_t>(site.added_faces()));
  twins_.resize(origins_.size());
}

void HalfEdgeMesh::append(const HalfEdgeMesh& components) {
  const std::uint32_t first_vertex = vertex_slots(), first_half_edge = 3 * face_slots();
  for (const VertexId v : components.origins_) origins_.emplace_back(first_vertex + v.value);
  for (const HalfEdgeId h : components.twins_) {
    twins_.push_back(h.valid() ? HalfEdgeId(first_half_edge + h.value) : h);
  }
  for (const HalfEdgeId h : components.outgoing_) outgoing_.emplace_back(first_half_edge + h.value);
  live_vertices_ += components.live_vertices_;
  live_faces_ += components.live_faces_;
}

void HalfEdgeMesh::undo_append(std::uint32_t vertices, std::uint32_t faces) {
  origins_.resize(origins_.size() - 3 * std::size_t{faces});
  twins_.resize(origins_.size());
  outgoing_.resize(outgoing_.size() - vertices);
  live_vertices_ -= vertices;
  live_faces_ -= faces;
}

SplitSite HalfEdgeMesh::find_site(const HalfEdgeCollapse& collapse) const {
  SplitSite site;
  const auto count = [](std::uint32_t faces) {
    assert(faces <= kMaxMovedFaces);
    return static_cast<std::uint16_t>(faces);
  };
  if (collapse.left.valid() && collapse.right.valid()) {
    site.half_edge = find_edge(collapse.kept, collapse.left);
    assert(origin(site.half_edge) == collapse.kept);
    std::uint32_t moved = 1;
    for (HalfEdgeId h = site.half_edge; apex(h) != collapse.right; h = rotate_ccw(h)) ++moved;
    site.moved_faces = count(moved);
    return site;
  }
  std::uint32_t moved = 0;
  if (collapse.right.valid()) {
    site.kind = SplitKind::border_first;
    site.half_edge = outgoing(collapse.kept);
    for (HalfEdgeId h = site.half_edge; h.valid() && target(h) != collapse.right;
         h = rotate_ccw(h)) {
      ++moved;
    }
  } else {  // the faces from kept -> left to the end of the fan; none if left ends the fan
    site.kind = SplitKind::border_last;
    site.half_edge = find_edge(collapse.kept, collapse.left);
    HalfEdgeId h = origin(site.half_edge) == collapse.kept ? site.half_edge : HalfEdgeId();
    for (; h.valid(); h = rotate_ccw(h)) {
      ++moved;
      site.half_edge = prev(h);
    }
  }
  site.moved_faces = count(moved);
  return site;
}

}  // namespace pmesh
