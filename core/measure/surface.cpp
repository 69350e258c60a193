#include "core/measure/surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/measure/face_neighbours.h"
#include "core/measure/spatial_order.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

// The faces of `mesh` in spatial order of their centres.
std::vector<std::uint32_t> ordered_faces(MeshView mesh, const UnitFrame& frame, unsigned threads) {
  std::vector<Vec3d> centers(mesh.triangles.size());
  for_blocks(static_cast<std::uint32_t>(centers.size()), threads,
             [&](std::uint32_t begin, std::uint32_t end) {
               for (std::uint32_t face = begin; face < end; ++face) {
                 const Triangle& t = mesh.triangles[face];
                 const Vec3d a = frame.to_unit(mesh.positions[t[0]]);
                 const Vec3d b = frame.to_unit(mesh.positions[t[1]]);
                 const Vec3d c = frame.to_unit(mesh.positions[t[2]]);
                 centers[face] = (1.0 / 3) * (a + b + c);
               }
             });
  return spatial_order(centers, threads);
}

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest <= value ? nearest
                          : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

Box<float> outer_box(const Corners& t) {
  const auto low = [](double a, double b, double c) { return rounded_down(std::min({a, b, c})); };
  const auto high = [](double a, double b, double c) {
    return -rounded_down(-std::max({a, b, c}));
  };
  return {{low(t.a.x, t.b.x, t.c.x), low(t.a.y, t.b.y, t.c.y), low(t.a.z, t.b.z, t.c.z)},
          {high(t.a.x, t.b.x, t.c.x), high(t.a.y, t.b.y, t.c.y), high(t.a.z, t.b.z, t.c.z)}};
}

}  // namespace

Result<UnitFrame> unit_frame(const Box<double>& box) {
  const double side = box.longest_side();
  if (!std::isfinite(side)) return bad_input("the bounding box is too large to be measured");
  UnitFrame frame;
  frame.center = {std::midpoint(box.low.x, box.high.x), std::midpoint(box.low.y, box.high.y),
                  std::midpoint(box.low.z, box.high.z)};
  // The largest power of two that keeps half a side within 1 and is itself, like its inverse, a
  // normal number.
  const int exponent = side > 0 ? std::clamp(-std::ilogb(side), -1000, 1000) : 0;
  frame.scale = std::ldexp(1.0, exponent);
  return frame;
}

Box<double> box_of_faces(MeshView mesh) {
  assert(!mesh.triangles.empty());
  const Vec3d first = mesh.positions[mesh.triangles.front()[0]];
  Box<double> box{first, first};
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3d p = mesh.positions[v];
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
  }
  return box;
}

Surface::Surface(MeshView mesh, const UnitFrame& frame, unsigned threads)
    : given_faces_(ordered_faces(mesh, frame, threads)) {
  std::vector<std::uint32_t> place(mesh.positions.size(), kNoIndex);
  triangles_.resize(given_faces_.size());
  faces_by_given_.resize(given_faces_.size());
  for (std::uint32_t face = 0; face < face_count(); ++face) {
    faces_by_given_[given_faces_[face]] = face;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t given = mesh.triangles[given_faces_[face]][k];
      if (place[given] == kNoIndex) {
        place[given] = vertex_count();
        positions_.push_back(frame.to_unit(mesh.positions[given]));
      }
      triangles_[face][k] = place[given];
    }
  }
  neighbours_ = face_neighbours(triangles_, vertex_count());
  std::vector<Box<float>> boxes(face_count());
  for_blocks(face_count(), threads, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t face = begin; face < end; ++face) boxes[face] = outer_box(corners(face));
  });
  tree_ = FaceTree(boxes);
}

NearestFace Surface::nearest(Vec3d p, std::uint32_t hint) const {
  NearestFace start;
  if (hint != kNoIndex) start = {squared_distance(p, hint), hint};
  return tree_.nearest(p, start, [&](std::uint32_t face) { return squared_distance(p, face); });
}

NearestFace Surface::near(Vec3d p, std::uint32_t hint) const {
  return tree_.near(p, {squared_distance(p, hint), hint},
                    [&](std::uint32_t face) { return squared_distance(p, face); });
}

}  // namespace pmesh
