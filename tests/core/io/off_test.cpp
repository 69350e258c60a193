#include <gtest/gtest.h>

#include "tests/core/io/samples.h"

namespace pmesh {
namespace {

ImportedMesh off(const std::string& text) { return parsed(MeshFormat::off, text); }
std::string off_error(const std::string& text) { return error_of(MeshFormat::off, text); }
std::string with(const std::string& from, const std::string& to) {
  return replaced(kOff, from, to);
}

TEST(Off, ReadsVerticesAndFaces) { expect_tetrahedron(off(kOff)); }

TEST(Off, TakesCountsOnTheFirstLineOrWithoutAHeaderOrWithoutEdges) {
  expect_tetrahedron(off(with("OFF\n", "OFF ")));
  expect_tetrahedron(off(with("OFF\n", "")));
  expect_tetrahedron(off(with("4 4 6", "4 4")));
}

TEST(Off, TakesAnyLineEnd) {
  expect_tetrahedron(off(replaced(kOff, "\n", "\r\n")));
  expect_tetrahedron(off(replaced(kOff, "\n", "\r")));
  expect_tetrahedron(off(kOff.substr(0, kOff.size() - 1)));
}

TEST(Off, PassesOverComments) {
  expect_tetrahedron(
      off("# made by hand\n" + with("OFF\n", "OFF # a word\n\n# counts\n") + "\n# end\n"));
}

TEST(Off, PassesOverNormalsAndColours) {
  expect_tetrahedron(
      off(replaced(with("OFF", "STCNOFF"), "0 1.5 0", "0 1.5 0 0 0 1 255 0 0 0.5 0.5")));
  expect_tetrahedron(off(with("3 1 2 3", "3 1 2 3 0.5 0.5 0.5 # grey")));
}

TEST(Off, CutsPolygonsIntoFans) {
  const ImportedMesh mesh = off(with("3 1 2 3\n", "4 1 2 3 0\n"));
  EXPECT_EQ(mesh.polygons, 1u);
  EXPECT_EQ(mesh.mesh.triangles.size(), 5u);
}

TEST(Off, RefusesOtherKinds) {
  EXPECT_EQ(off_error(""), "line 1: expected 'OFF', found ''");
  EXPECT_EQ(off_error("ply\n"), "line 1: expected 'OFF', found 'ply'");
  EXPECT_EQ(off_error(with("OFF", "4OFF")),
            "line 1: '4OFF': only three coordinates a vertex are supported");
  EXPECT_EQ(off_error(with("OFF", "OFF BINARY")), "line 1: binary OFF is not supported");
}

TEST(Off, RefusesWrongCounts) {
  EXPECT_EQ(off_error(with("4 4 6", "-4 4 6")), "line 2: expected a count, found '-4'");
  EXPECT_EQ(off_error(with("4 4 6", "4")), "line 2: expected a count, found ''");
  EXPECT_EQ(off_error(with("4 4 6", "4000000000 4 6")),
            "line 2: 4000000000 vertices and 4 faces, but 62 bytes follow");
  EXPECT_EQ(off_error(with("4 4 6", "4 5 6")), "line 10: the file ends after 4 of 5 faces");
  EXPECT_EQ(off_error(with("4 4 6", "9 4 6")), "line 10: the file ends after 8 of 9 vertices");
  EXPECT_EQ(off_error(with("4 4 6", "4 3 6")), "line 10: expected 3 faces, found more");
  EXPECT_EQ(off_error("OFF\n"), "line 1: the file ends early");
}

TEST(Off, RefusesMalformedRows) {
  EXPECT_EQ(off_error(with("0 1.5 0", "0 1.5")), "line 5: expected 3 numbers, found 2");
  EXPECT_EQ(off_error(with("0 1.5 0", "0 nan 0")), "line 5: the coordinate 'nan' is not finite");
  EXPECT_EQ(off_error(with("3 0 1 3", "3 0 1")), "line 8: expected 3 corners, found 2");
  EXPECT_EQ(off_error(with("3 0 1 3", "3 0 1 a")), "line 8: expected a vertex index, found 'a'");
  EXPECT_EQ(off_error(with("3 0 1 3", "x 0 1 3")), "line 8: expected a count, found 'x'");
}

TEST(Off, RefusesBadFaces) {
  EXPECT_EQ(off_error(with("3 0 1 3", "3 0 1 4")),
            "line 8: face 1: vertex index 4 is out of range: the mesh has 4 vertices");
  EXPECT_EQ(off_error(with("3 0 1 3", "2 0 1")),
            "line 8: face 1: expected 3 or more corners, found 2");
}

}  // namespace
}  // namespace pmesh
