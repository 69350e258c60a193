// The connectivity of an oriented triangle 2-manifold with or without borders, and its two edits:
// half-edge collapse and vertex split, exact inverses of each other (see split() and undo_split()).
//
// Three half-edges a face, stored together: half-edge 3f+k leaves corner k of face f, so next, prev
// and face are arithmetic, and the corner array is at the same time an index buffer for a GPU.
// 24 bytes a face and 4 a vertex. (Why not twin = id xor 1: docs/decisions/0002.)
//
// Geometry is stored elsewhere, indexed by vertex. Orientation: faces are counter-clockwise, and
// "ccw" around a vertex means the same.
//
//                 left
//                /    \            The edge (removed, kept) with its two faces: L, to the left
//               /  L   \           of removed -> kept, and R, to its right. A collapse of removed
//        removed ------ kept       into kept deletes L and R; removed's other faces, the moved
//               \  R   /           fan, become kept's. On a border one of L and R is missing.
//                \    /
//                 right
//
// Invariants (validate() checks them all):
//  - twin(twin(h)) == h, and origin(twin(h)) == target(h): neighbours agree in orientation;
//  - a half-edge without a twin is a border half-edge;
//  - outgoing(v) leaves v; if v lies on a border it is the border half-edge, the first of v's fan
//    in ccw order, so that rotating ccw from it meets every face of v;
//  - every vertex has exactly one fan of faces (no bow-ties), and no two faces have the same
//    directed edge.
//
// Threads: const members may be called at the same time; edits need the mesh to themselves.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// A half-edge collapse in vertex ids; enough to find the vertex split that undoes it.
struct HalfEdgeCollapse {
  VertexId removed;
  VertexId kept;
  VertexId left;   ///< Apex of the deleted face left of removed -> kept; invalid if there is none.
  VertexId right;  ///< Apex of the deleted face right of it; invalid if there is none.

  int removed_faces() const { return int{left.valid()} + int{right.valid()}; }
};

enum class SplitKind : std::uint8_t {
  interior,      ///< Adds L and R.
  border_first,  ///< Adds R only: the new vertex takes the first faces of a border vertex's fan.
  border_last,   ///< Adds L only: the new vertex takes the last faces of a border vertex's fan.
};

/// No collapse or split moves more faces than this, so that its work is bounded by a constant (a PM
/// file stores the count in a byte). A vertex with a larger fan is not removed until its
/// neighbours' collapses have made the fan smaller.
inline constexpr std::uint32_t kMaxMovedFaces = 255;

/// Where a vertex is split, in half-edge ids of the mesh just before the split.
struct SplitSite {
  /// interior: kept -> left, the first moved face's.
  /// border_first: kept's first outgoing half-edge (a border half-edge leaving kept).
  /// border_last: the last incoming half-edge of kept's fan (a border half-edge ending in kept).
  HalfEdgeId half_edge;
  /// Faces that the new vertex takes over, ccw (border_last: cw) from there. At least 1 for
  /// interior; 0 on a border glues one new face (an "ear") to the border half-edge.
  std::uint16_t moved_faces = 0;
  SplitKind kind = SplitKind::interior;

  int added_faces() const { return kind == SplitKind::interior ? 2 : 1; }
  friend bool operator==(const SplitSite&, const SplitSite&) = default;
};

/// The live part of a mesh, its vertices and faces numbered anew without gaps.
struct LiveMesh {
  std::vector<Triangle> triangles;
  std::vector<VertexId> vertices;  ///< By new vertex: its id in the mesh.
  std::vector<FaceId> faces;       ///< By new face: its id in the mesh.
};

/// What compact() did to ids. The new ones have no gaps, and the order of the old ones.
struct CompactIds {
  std::vector<VertexId> vertices;      ///< By new id: the old one.
  std::vector<FaceId> faces;           ///< The same.
  std::vector<VertexId> new_vertices;  ///< By old id of a vertex that was live.
};

/// Moves what is stored by old id to where its new id is; `old_ids` by new id, ascending.
template <class T, class AnyId>
void close_up(std::vector<T>& stored, const std::vector<AnyId>& old_ids) {
  for (std::size_t i = 0; i < old_ids.size(); ++i) stored[i] = stored[old_ids[i].value];
  stored.resize(old_ids.size());
}

class HalfEdgeMesh {
 public:
  HalfEdgeMesh() = default;

  /// The mesh of `triangles` over vertices 0..vertex_count-1; face f is triangles[f], half-edge
  /// 3f+k leaves triangles[f][k]. Fails (bad_input, naming a face or vertex) if an index is out of
  /// range or repeated in a face, if the faces are not an oriented 2-manifold as described above,
  /// or if a vertex has no face. O(faces log(max valence)).
  static Result<HalfEdgeMesh> build(std::span<const Triangle> triangles,
                                    std::uint32_t vertex_count);

  /// Checks every invariant. O(faces log faces). For tests, verify and debugging.
  Status validate() const;

  /// The live vertices and faces, both in the order of their ids.
  LiveMesh live() const;

  // Sizes. Ids run below the slot counts; a collapse leaves dead slots.
  std::uint32_t vertex_slots() const { return static_cast<std::uint32_t>(outgoing_.size()); }
  std::uint32_t face_slots() const { return static_cast<std::uint32_t>(twins_.size() / 3); }
  std::uint32_t live_vertices() const { return live_vertices_; }
  std::uint32_t live_faces() const { return live_faces_; }
  bool is_live(VertexId v) const { return outgoing_[v.value].valid(); }
  bool is_live(FaceId f) const { return origins_[3 * f.value].valid(); }

  // Navigation. Arguments must be live.
  // (Corner 2 is followed, and corner 0 preceded, by one two places away. No branches: nobody could
  // guess which corner comes next.)
  static HalfEdgeId next(HalfEdgeId h) { return HalfEdgeId(h.value + 1 - 3 * (h.value % 3 / 2)); }
  static HalfEdgeId prev(HalfEdgeId h) {
    return HalfEdgeId(h.value - 1 + 3 * ((2 - h.value % 3) / 2));
  }
  static FaceId face(HalfEdgeId h) { return FaceId(h.value / 3); }
  VertexId origin(HalfEdgeId h) const { return origins_[h.value]; }
  VertexId target(HalfEdgeId h) const { return origins_[next(h).value]; }
  VertexId apex(HalfEdgeId h) const { return origins_[prev(h).value]; }
  /// Invalid on a border.
  HalfEdgeId twin(HalfEdgeId h) const { return twins_[h.value]; }
  HalfEdgeId outgoing(VertexId v) const { return outgoing_[v.value]; }
  /// The next outgoing half-edge of the same vertex, counter-clockwise; invalid past a border.
  HalfEdgeId rotate_ccw(HalfEdgeId h) const { return twin(prev(h)); }
  /// The same clockwise.
  HalfEdgeId rotate_cw(HalfEdgeId h) const {
    const HalfEdgeId t = twin(h);
    return t.valid() ? next(t) : t;
  }
  bool is_border(HalfEdgeId h) const { return !twin(h).valid(); }
  bool is_border(VertexId v) const { return is_border(outgoing(v)); }
  /// Ask for what there is of a vertex or half-edge to be brought into the caches.
  void prefetch(VertexId v) const { __builtin_prefetch(&outgoing_[v.value]); }
  void prefetch(HalfEdgeId h) const {
    __builtin_prefetch(&origins_[h.value]);
    __builtin_prefetch(&twins_[h.value]);
  }
  /// Of a half-edge's face the corners only.
  void prefetch_corners(HalfEdgeId h) const { __builtin_prefetch(&origins_[h.value]); }
  /// Of the faces across a half-edge and the one before it, whose own face should be there.
  void prefetch_neighbours(HalfEdgeId h) const {
    if (const HalfEdgeId t = twin(h); t.valid()) prefetch(t);
    if (const HalfEdgeId t = twin(prev(h)); t.valid()) prefetch(t);
  }
  /// The corners of face f are elements 3f, 3f+1 and 3f+2; dead faces hold invalid ids.
  std::span<const VertexId> corners() const { return origins_; }

  /// The half-edge between `a` and `b` that leaves `a`, or, if that one does not exist on a border,
  /// the one that leaves `b`; invalid if they are not neighbours. O(smaller valence).
  HalfEdgeId find_edge(VertexId a, VertexId b) const;

  /// Collapses `edge` (either of its half-edges): its end `removed` merges into the other end.
  /// Preconditions: the link condition holds (the ends' common neighbours are the apexes of the
  /// edge's faces, and no vertex loses its last face; a tetrahedron becomes two faces back to
  /// back); `removed` is no border vertex unless the edge is a border edge. Dead slots remain for
  /// `removed` and the edge's faces.
  HalfEdgeCollapse collapse(VertexId removed, HalfEdgeId edge) {
    const HalfEdgeCollapse done = collapse_uncounted(removed, edge);
    count(done);
    return done;
  }

  /// Its two steps. Several threads may take the first at the same time, for collapses of which no
  /// two have a vertex in common, be it removed or one of its neighbours. Before anything else is
  /// asked of the mesh, count() is to be called for each.
  HalfEdgeCollapse collapse_uncounted(VertexId removed, HalfEdgeId edge);
  void count(const HalfEdgeCollapse& done) {
    --live_vertices_;
    live_faces_ -= static_cast<std::uint32_t>(done.removed_faces());
  }

  /// Why `site` cannot be split here, or success. Never reads out of bounds, whatever the site.
  /// O(moved faces).
  Status check(const SplitSite& site) const;

  /// Splits a vertex: appends one vertex and one or two faces, L = (new, kept, left) before
  /// R = (new, right, kept). Precondition: check(site), and no dead slots. Returns kept.
  VertexId split(const SplitSite& site);

  /// Undoes the last split, which was at `site`: the faces, twins and live counts are again what
  /// they were, bit for bit. (outgoing() of an interior vertex may differ: any is valid.)
  void undo_split(const SplitSite& site);

  /// Appends `components`: its vertices and faces get the next ids, in their order. Preconditions:
  /// no dead slots in either, and both together have at most kNoIndex / 3 faces.
  void append(const HalfEdgeMesh& components);

  /// Undoes the last append(), which was of a mesh of that many vertices and faces.
  void undo_append(std::uint32_t vertices, std::uint32_t faces);

  /// Gives what is live compact ids; no dead slots remain. O(slots).
  CompactIds compact();

  /// The reverse: vertex v becomes vertices[v] and face f becomes faces[f], among dead slots.
  /// Precondition: no dead slots; ids below the slots, each once.
  void spread(std::span<const VertexId> vertices, std::span<const FaceId> faces,
              std::uint32_t vertex_slots, std::uint32_t face_slots);

  /// The site whose split undoes `collapse`, in this mesh, the state just after it.
  /// The moved fan must have at most kMaxMovedFaces faces. O(moved faces + the smaller valence
  /// of kept and left).
  SplitSite find_site(const HalfEdgeCollapse& collapse) const;

  void reserve(std::uint32_t vertices, std::uint32_t faces);

 private:
  Status match_twins(std::span<const Triangle> triangles);
  Status anchor_vertices();  // each at its border half-edge, if it has one
  struct MovedFan;
  MovedFan move_fan(const SplitSite& site, VertexId added);
  HalfEdgeId append_left(const MovedFan& fan, VertexId added);   // L; its added -> kept
  HalfEdgeId append_right(const MovedFan& fan, VertexId added);  // R; its kept -> added
  void set_twins(HalfEdgeId a, HalfEdgeId b);
  void kill_face(FaceId f);
  FaceId append_face(VertexId a, VertexId b, VertexId c);

  std::vector<VertexId> origins_;     // by half-edge
  std::vector<HalfEdgeId> twins_;     // by half-edge
  std::vector<HalfEdgeId> outgoing_;  // by vertex
  std::uint32_t live_vertices_ = 0;
  std::uint32_t live_faces_ = 0;
};

}  // namespace pmesh
