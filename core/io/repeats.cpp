#include "core/io/repeats.h"

#include <algorithm>
#include <array>

namespace pmesh {
namespace {

// A face by its vertices in ascending order, so that copies are neighbours once sorted.
struct SortedFace {
  Triangle vertices;
  std::uint32_t face;

  friend auto operator<=>(const SortedFace&, const SortedFace&) = default;
};

std::vector<SortedFace> sorted_faces(std::span<const Triangle> triangles) {
  std::vector<SortedFace> faces(triangles.size());
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    faces[f] = {triangles[f], f};
    std::sort(faces[f].vertices.begin(), faces[f].vertices.end());
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

// The orientation of a face relative to its vertices' ascending order.
bool is_ascending(const Triangle& t) {
  return int{t[0] < t[1]} + int{t[1] < t[2]} + int{t[2] < t[0]} == 2;
}

bool is_degenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

}  // namespace

DroppedFaces drop_repeats(std::vector<Triangle>& triangles) {
  DroppedFaces dropped;
  dropped.degenerate = std::erase_if(triangles, is_degenerate);
  const std::vector<SortedFace> faces = sorted_faces(triangles);
  std::array<bool, 2> seen{};  // by orientation
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (i == 0 || faces[i].vertices != faces[i - 1].vertices) seen = {};
    Triangle& t = triangles[faces[i].face];
    bool& is_repeat = seen[is_ascending(t) ? 1 : 0];
    if (is_repeat) t = {};  // marked as degenerate, and so dropped below
    is_repeat = true;
  }
  dropped.duplicate = std::erase_if(triangles, is_degenerate);
  return dropped;
}

std::vector<FaceId> find_opposites(std::span<const Triangle> triangles) {
  std::vector<FaceId> opposites(triangles.size());
  const std::vector<SortedFace> faces = sorted_faces(triangles);
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].vertices != faces[i - 1].vertices) continue;
    opposites[faces[i].face] = FaceId(faces[i - 1].face);
    opposites[faces[i - 1].face] = FaceId(faces[i].face);
  }
  return opposites;
}

}  // namespace pmesh
