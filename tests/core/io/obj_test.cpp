#include <gtest/gtest.h>

#include "tests/core/io/samples.h"

namespace pmesh {
namespace {

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

ImportedMesh obj(const std::string& text) { return parsed(MeshFormat::obj, text); }
std::string obj_error(const std::string& text) { return error_of(MeshFormat::obj, text); }

TEST(Obj, ReadsAllFormsOfCorners) { expect_tetrahedron(obj(kObj)); }

TEST(Obj, TakesAnyLineEnd) {
  expect_tetrahedron(obj(replaced(kObj, "\n", "\r\n")));
  expect_tetrahedron(obj(replaced(kObj, "\n", "\r")));
  expect_tetrahedron(obj(kObj.substr(0, kObj.size() - 1)));
  expect_tetrahedron(obj("\xEF\xBB\xBF" + kObj));
}

TEST(Obj, CountsNegativeIndicesFromTheLatestVertex) {
  const ImportedMesh mesh = obj(kThree + "f -3 -2 -1\nv 0 0 1\nf -2 -1 -4\n");
  EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 3, 0}}));
}

TEST(Obj, PassesOverWeightsAndColours) {
  const ImportedMesh mesh = obj("v 0.1 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\n  v\t0 +1e0 0\nf 1 2 3\n");
  EXPECT_EQ(mesh.mesh.positions, (std::vector<Vec3d>{{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Obj, PassesOverAllOtherStatements) {
  const ImportedMesh mesh =
      obj("mtllib C:\\models\\\ng a\n" + kThree +
          "vn 0 0 1\nvt x\nl 1 2\np 1\ns off\nusemtl\nf 1 2 3\n# f 1 2 9 \\\n");
  EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Obj, JoinsContinuedLines) {
  const ImportedMesh mesh = obj("v 0 \\\n 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2\\\r\n4 \\ \n3\n");
  EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}}));
  EXPECT_EQ(mesh.polygons, 1u);
}

TEST(Obj, NamesTheFirstOfJoinedLinesAndCountsThemAll) {
  EXPECT_EQ(obj_error("v 0 \\\n\\\n 0\n" + kThree), "line 1: expected 3 numbers, found 2");
  EXPECT_EQ(obj_error(kThree + "f 1 \\\n 2 3\nf 1 x 3\n"),
            "line 6: expected a vertex index, found 'x'");
}

TEST(Obj, TakesVerticesAfterTheirFaces) {
  EXPECT_EQ(obj("f 1 2 3\n" + kThree).mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Obj, RefusesMalformedVertices) {
  EXPECT_EQ(obj_error("v 0 0 0\nv 1 2\n"), "line 2: expected 3 numbers, found 2");
  EXPECT_EQ(obj_error("v 0 0x1 0\n"), "line 1: expected a number, found '0x1'");
  EXPECT_EQ(obj_error("v 0 0 inf\n"), "line 1: the coordinate 'inf' is not finite");
  EXPECT_EQ(obj_error("v 0 0 1e999\n"), "line 1: the coordinate '1e999' is not finite");
}

TEST(Obj, RefusesIndicesOutOfRange) {
  EXPECT_EQ(obj_error(kThree + "f 1 2 3\nf 1 2 9\nf 1 2 4\n"),
            "line 5: vertex index 9 is out of range: the mesh has 3 vertices");
  EXPECT_EQ(obj_error(kThree + "f 1 2 4294967299\n"),
            "line 4: vertex index 4294967299 is out of range: the mesh has 3 vertices");
  EXPECT_EQ(obj_error(kThree + "f 1 2 -4\n"),
            "line 4: vertex index -4 is out of range: the mesh has 3 vertices");
  EXPECT_EQ(obj_error(kThree + "f 1 2 0\n"), "line 4: vertex index 0: indices begin at 1");
}

TEST(Obj, RefusesMalformedFaces) {
  EXPECT_EQ(obj_error(kThree + "f 1 2\n"), "line 4: expected 3 or more corners, found 2");
  EXPECT_EQ(obj_error(kThree + "f\n"), "line 4: expected 3 or more corners, found 0");
  EXPECT_EQ(obj_error(kThree + "f 1 2 /3\n"), "line 4: expected a vertex index, found '/3'");
  EXPECT_EQ(obj_error(kThree + "f 1 2 1.5\n"), "line 4: expected a vertex index, found '1.5'");
}

TEST(Obj, RefusesAFileWithoutFaces) {
  EXPECT_EQ(obj_error(""), "the mesh has no faces");
  EXPECT_EQ(obj_error(kThree), "the mesh has no faces");
}

}  // namespace
}  // namespace pmesh
