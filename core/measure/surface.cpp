#include "core/measure/surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/measure/face_neighbours.h"
#include "core/measure/spatial_order.h"
#include "core/parallel/for_blocks.h"

namespace pmesh {
namespace {

// A float that is not above the value: at most 2^-24 of a number is rounded away.
float rounded_down(double value) {
  constexpr double kRelative = 1.0 / (1 << 23), kLeast = 1e-30;
  return static_cast<float>(value - (kRelative * std::abs(value) + kLeast));
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

SpatialOrder spatial_order_of(MeshView mesh, const UnitFrame& frame, unsigned threads) {
  std::vector<Vec3d> centers(mesh.triangles.size());
  for_each_index(centers.size(), threads, [&](std::uint32_t face) {
    const Triangle& t = mesh.triangles[face];
    const Vec3d a = frame.to_unit(mesh.positions[t[0]]);
    const Vec3d b = frame.to_unit(mesh.positions[t[1]]);
    const Vec3d c = frame.to_unit(mesh.positions[t[2]]);
    centers[face] = (1.0 / 3) * (a + b + c);
  });
  SpatialOrder order{spatial_order(centers, threads), {}};
  order.vertices.reserve(mesh.positions.size());
  std::vector<bool> is_met(mesh.positions.size(), false);
  for (const std::uint32_t face : order.faces) {
    for (const std::uint32_t v : mesh.triangles[face]) {
      if (is_met[v]) continue;
      is_met[v] = true;
      order.vertices.push_back(v);
    }
  }
  return order;
}

Surface::Surface(MeshView mesh, const UnitFrame& frame, unsigned threads, const SpatialOrder& order)
    : given_faces_(order.faces) {
  place(mesh, frame, order.vertices, threads);
  place_neighbours(mesh, threads);
  std::vector<Box<float>> boxes(face_count());
  for_each_index(face_count(), threads,
                 [&](std::uint32_t face) { boxes[face] = outer_box(corners(face)); });
  tree_ = FaceTree(boxes);
}

void Surface::place(MeshView mesh, const UnitFrame& frame, std::span<const std::uint32_t> vertices,
                    unsigned threads) {
  std::vector<std::uint32_t> places(mesh.positions.size());
  positions_.resize(vertices.size());
  for_each_index(vertices.size(), threads, [&](std::uint32_t vertex) {
    places[vertices[vertex]] = vertex;
    positions_[vertex] = frame.to_unit(mesh.positions[vertices[vertex]]);
  });
  triangles_.resize(given_faces_.size());
  faces_by_given_.resize(given_faces_.size());
  for_each_index(face_count(), threads, [&](std::uint32_t face) {
    const std::uint32_t given = given_faces_[face];
    faces_by_given_[given] = face;
    for (std::size_t k = 0; k < 3; ++k) triangles_[face][k] = places[mesh.triangles[given][k]];
  });
}

void Surface::place_neighbours(MeshView mesh, unsigned threads) {
  if (mesh.neighbours.empty()) {
    neighbours_ = face_neighbours(triangles_, vertex_count());
    return;
  }
  neighbours_.resize(face_count());
  for_each_index(face_count(), threads, [&](std::uint32_t face) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t beyond = mesh.neighbours[given_faces_[face]][k];
      neighbours_[face][k] = beyond == kNoIndex ? kNoIndex : faces_by_given_[beyond];
    }
  });
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
