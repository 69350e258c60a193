#include "core/measure/face_marks.h"

#include <gtest/gtest.h>

#include "tests/core/measure/unit_surface.h"
#include "tests/fixtures/shapes.h"

namespace pmesh {
namespace {

using Below = FaceMarks::Below;

// Whether a walk down the tree finds a face.
bool is_found(const FaceMarks& marks, std::uint32_t face) {
  const std::uint32_t node = face / FaceTree::kWidth;
  return marks.below(0, node) == Below::all || marks.all_above(0, node) ||
         (marks.below(0, node) == Below::some && marks.is_marked(face));
}

bool meets(const Corners& t, const Box<double>& box) {
  return std::min({t.a.x, t.b.x, t.c.x}) <= box.high.x &&
         std::max({t.a.x, t.b.x, t.c.x}) >= box.low.x &&
         std::min({t.a.y, t.b.y, t.c.y}) <= box.high.y &&
         std::max({t.a.y, t.b.y, t.c.y}) >= box.low.y &&
         std::min({t.a.z, t.b.z, t.c.z}) <= box.high.z &&
         std::max({t.a.z, t.b.z, t.c.z}) >= box.low.z;
}

TEST(FaceMarks, FindTheFacesMarkedAndNoOther) {
  const Surface surface = unit_surface(shapes::icosphere(3));
  FaceMarks marks(surface.tree());
  EXPECT_FALSE(marks.any());
  marks.mark(17);
  marks.mark(1000);
  EXPECT_TRUE(marks.any());
  for (std::uint32_t face = 0; face < surface.face_count(); ++face) {
    EXPECT_EQ(is_found(marks, face), face == 17 || face == 1000);
  }
}

TEST(FaceMarks, FindAllFacesNearABox) {
  const Surface surface = unit_surface(shapes::icosphere(4));
  const Box<double> box{{-0.3, -2, 0.1}, {0.4, 2, 2}};
  FaceMarks marks(surface.tree());
  marks.mark_near(box);
  std::uint32_t found = 0;
  for (std::uint32_t face = 0; face < surface.face_count(); ++face) {
    if (is_found(marks, face)) ++found;
    EXPECT_TRUE(is_found(marks, face) || !meets(surface.corners(face), box));
  }
  EXPECT_LT(found, surface.face_count() / 2);
}

TEST(FaceMarks, FindAllFacesInABoxAroundThem) {
  const Surface surface = unit_surface(shapes::icosphere(2));
  FaceMarks marks(surface.tree());
  marks.mark_near({{-9, -9, -9}, {9, 9, 9}});
  for (std::uint32_t face = 0; face < surface.face_count(); ++face) {
    EXPECT_TRUE(is_found(marks, face));
  }
}

}  // namespace
}  // namespace pmesh
