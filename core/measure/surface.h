// A triangle mesh made ready to be measured: in unit coordinates, its faces and vertices in spatial
// order, with a tree of the faces' boxes. About 75 bytes a face.
//
// Threads: const members may be called at the same time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/box.h"
#include "core/base/result.h"
#include "core/base/vec3.h"
#include "core/measure/face_tree.h"
#include "core/measure/point_triangle.h"
#include "core/mesh/indexed_mesh.h"

namespace pmesh {

/// From a mesh's units to coordinates of about [-1, 1] and back, so that neither squares nor
/// single precision lose anything to where a mesh is and how large.
struct UnitFrame {
  Vec3d center;
  double scale = 1;  ///< A power of two: scaling rounds nothing.

  Vec3d to_unit(Vec3d position) const { return scale * (position - center); }
  double to_length(double unit_length) const { return unit_length / scale; }
};

/// The frame for a box. Fails (bad_input) if the box's size is not a finite double.
Result<UnitFrame> unit_frame(const Box<double>& box);

/// Unit lengths up to this are what rounding makes of no distance at all.
inline constexpr double kNoDistance = 1e-14;

/// A mesh's positions and triangles, which must outlive the view.
struct MeshView {
  std::span<const Vec3d> positions;
  std::span<const Triangle> triangles;
  /// By triangle, the ones beyond edges ab, bc and ca, or kNoIndex; or empty: they are found.
  std::span<const std::array<std::uint32_t, 3>> neighbours = {};
};

/// Of the vertices that faces use. Precondition: there is a face.
Box<double> box_of_faces(MeshView mesh);

/// The numbers of a mesh's faces, and of the vertices that they use, along a curve through space.
struct SpatialOrder {
  std::vector<std::uint32_t> faces, vertices;
};
SpatialOrder spatial_order_of(MeshView mesh, const UnitFrame& frame, unsigned threads);

struct Corners {
  Vec3d a, b, c;
};

class Surface {
 public:
  /// Preconditions: the mesh has a triangle, its indices are in range, its positions are finite and
  /// near the box of `frame`.
  Surface(MeshView mesh, const UnitFrame& frame, unsigned threads)
      : Surface(mesh, frame, threads, spatial_order_of(mesh, frame, threads)) {}
  /// In an order that is known: of all faces, and of the vertices that they use. The better it is
  /// as a spatial one, the faster are queries.
  Surface(MeshView mesh, const UnitFrame& frame, unsigned threads, const SpatialOrder& order);

  std::uint32_t face_count() const { return static_cast<std::uint32_t>(triangles_.size()); }
  /// Vertices that a face uses.
  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions_.size()); }
  /// By face: its number in the mesh given; and back.
  std::uint32_t given_face(std::uint32_t face) const { return given_faces_[face]; }
  std::uint32_t face_given_as(std::uint32_t given) const { return faces_by_given_[given]; }
  const Triangle& triangle(std::uint32_t face) const { return triangles_[face]; }
  Vec3d position(std::uint32_t vertex) const { return positions_[vertex]; }
  Corners corners(std::uint32_t face) const {
    const Triangle& t = triangles_[face];
    return {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
  }

  /// The face beyond edge ab, bc or ca (k = 0, 1, 2), or kNoIndex.
  std::uint32_t neighbour(std::uint32_t face, std::size_t k) const { return neighbours_[face][k]; }

  /// The squared distance of `p` to a face.
  double squared_distance(Vec3d p, std::uint32_t face) const {
    const Corners t = corners(face);
    return squared_distance_to_triangle(p, t.a, t.b, t.c);
  }
  /// The face nearest to `p`. The answer's distance is exact whatever `hint` is, a face that may be
  /// near or kNoIndex; the nearer, the sooner it is found.
  NearestFace nearest(Vec3d p, std::uint32_t hint) const;

  /// A face not much farther than the nearest, often the nearest itself: faster by half. `hint` is
  /// a face.
  NearestFace near(Vec3d p, std::uint32_t hint) const;

  const FaceTree& tree() const { return tree_; }

 private:
  void place(MeshView mesh, const UnitFrame& frame, std::span<const std::uint32_t> vertices,
             unsigned threads);
  void place_neighbours(MeshView mesh, unsigned threads);

  std::vector<std::uint32_t> given_faces_, faces_by_given_;
  std::vector<Vec3d> positions_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
  FaceTree tree_;
};

/// Whether two corners are in one place. Cleaning drops some such faces and quantisation makes
/// others, and what they cover their neighbours cover: distances are measured to them, not from
/// them.
inline bool is_collapsed(const Corners& t) { return t.a == t.b || t.b == t.c || t.c == t.a; }

}  // namespace pmesh
