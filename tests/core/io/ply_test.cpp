#include <gtest/gtest.h>

#include "tests/core/io/samples.h"

namespace pmesh {
namespace {

ImportedMesh ply(const std::string& text) { return parsed(MeshFormat::ply, text); }
std::string ply_error(const std::string& text) { return error_of(MeshFormat::ply, text); }

// The sample with one part of it replaced.
std::string with(const std::string& from, const std::string& to) {
  return replaced(kAsciiPly, from, to);
}

TEST(Ply, ReadsAllEncodings) {
  expect_tetrahedron(ply(kAsciiPly));
  expect_tetrahedron(ply(binary_ply(false)));
  expect_tetrahedron(ply(binary_ply(true)));
}

TEST(Ply, TakesAnyLineEnd) {
  expect_tetrahedron(ply(replaced(kAsciiPly, "\n", "\r\n")));
  expect_tetrahedron(ply(replaced(kAsciiPly, "\n", "\r")));
  expect_tetrahedron(ply(kAsciiPly.substr(0, kAsciiPly.size() - 1)));
  expect_tetrahedron(ply("\xEF\xBB\xBF" + kAsciiPly));
}

TEST(Ply, TakesCrlfBeforeBinaryData) {
  const std::string header = ply_header("binary_little_endian");
  const std::string data = binary_ply(false).substr(header.size());
  expect_tetrahedron(ply(replaced(header, "\n", "\r\n") + data));
  expect_tetrahedron(ply(replaced(header, "\n", "\r") + data));
}

TEST(Ply, PassesOverComments) {
  expect_tetrahedron(ply(with("format", "comment made by hand\nobj_info num_cols 512\nformat")));
  expect_tetrahedron(ply(with("format", "Created by Blender3D 247\nformat")));
}

TEST(Ply, PassesOverBlankLinesAndPadding) {
  expect_tetrahedron(ply(with("0 0 -0.25\n", "\n0 0 -0.25\n  \n") + "\n \n" + '\0'));
  expect_tetrahedron(ply(binary_ply(false) + "\n" + '\0'));
}

TEST(Ply, KeepsDoublesExactly) {
  const ImportedMesh mesh = ply(with("0 1.5 0", "5000000.123456789 1e-310 -0.1"));
  EXPECT_EQ(mesh.mesh.positions[2], (Vec3d{5000000.123456789, 1e-310, -0.1}));
}

TEST(Ply, ReadsNumbersBeyondDoublesAsZeroIfSmall) {
  EXPECT_EQ(ply(with("0 1.5 0", "1e-400 0 0")).mesh.positions[2], (Vec3d{0, 0, 0}));
  EXPECT_EQ(ply_error(with("0 1.5 0", "1e400 0 0")),
            "line 12: vertex 2: a coordinate is not finite");
}

TEST(Ply, TakesPropertiesOfAnyOrderAndType) {
  std::string file =
      "ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty list uchar double k\n"
      "property float focal\nelement empty 7\nelement face 1\nproperty uchar flags\n"
      "property list short ushort vertex_index\nproperty list uint8 float32 texcoord\n"
      "element vertex 3\nproperty int8 z\nproperty list int int more\nproperty float64 x\n"
      "property uint16 y\nproperty uchar red\nend_header\n";
  file += '\2' + bytes_of(1.0, true) + bytes_of(2.0, true) + bytes_of(3.0f, true);
  file += '\xff' + bytes_of(std::int16_t{3}, true);
  for (const int corner : {2, 0, 1}) file += bytes_of(static_cast<std::uint16_t>(corner), true);
  file += '\1' + bytes_of(0.5f, true);
  for (int i = 0; i < 3; ++i) {
    file += bytes_of(static_cast<std::int8_t>(-i)) + bytes_of(1, true) + bytes_of(9, true);
    file += bytes_of(i + 0.1, true) + bytes_of(static_cast<std::uint16_t>(60000 + i), true) + '\7';
  }
  const ImportedMesh mesh = ply(file);
  EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{2, 0, 1}}));
  EXPECT_EQ(mesh.mesh.positions,
            (std::vector<Vec3d>{{0.1, 60000, 0}, {1.1, 60001, -1}, {2.1, 60002, -2}}));
}

TEST(Ply, PassesOverOtherElementsOfText) {
  expect_tetrahedron(ply(
      replaced(with("element face",
                    "element camera 2\nproperty list uchar float k\nproperty int n\nelement face"),
               "\n3 0 2 1\n", "\n2 1.5 nan 7\n0 8\n3 0 2 1\n")));
}

TEST(Ply, CutsPolygonsIntoFans) {
  const ImportedMesh mesh = ply(with("3 1 2 3\n", "4 1 2 3 0\n"));
  EXPECT_EQ(mesh.polygons, 1u);
  EXPECT_EQ(mesh.mesh.triangles,
            (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {1, 3, 0}, {2, 0, 3}}));
}

TEST(Ply, TurnsEverySecondTriangleOfAStrip) {
  std::string file = with("element face 4", "element tristrips 1");
  file = replaced(file, "uchar int", "int int");
  const std::string rows = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  const ImportedMesh mesh = ply(replaced(file, rows, "9 0 1 2 3 -1 1 2 0 3\n"));
  EXPECT_EQ(mesh.mesh.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {1, 2, 0}, {0, 2, 3}}));
}

TEST(Ply, KeepsUnreferencedVertices) {
  EXPECT_EQ(ply(with("3 2 0 3\n", "3 2 0 1\n")).mesh.positions.size(), 4u);
}

TEST(Ply, RefusesAMalformedHeader) {
  EXPECT_EQ(ply_error(""), "line 1: expected 'ply', found ''");
  EXPECT_EQ(ply_error("PK\3"), "line 1: expected 'ply', found 'PK?'");
  EXPECT_EQ(ply_error("ply\n"), "line 1: the file ends inside the header");
  EXPECT_EQ(ply_error("ply\nend_header\n"), "line 2: the header has no line 'format'");
  EXPECT_EQ(ply_error(with("ascii", "utf8")), "line 2: unknown format 'utf8'");
  EXPECT_EQ(ply_error(with("vertex 4", "vertex -4")), "line 3: expected a count, found '-4'");
  EXPECT_EQ(ply_error(with("vertex 4", "vertex 9223372036854775808")),
            "line 3: expected a count, found '9223372036854775808'");
  EXPECT_EQ(ply_error(with("float x", "flat x")), "line 4: unknown property type 'flat'");
  EXPECT_EQ(ply_error(with("property float y", "proprty float y")),
            "line 5: unknown header keyword 'proprty'");
  EXPECT_EQ(ply_error(with("element vertex 4\n", "")),
            "line 3: a property before the first element");
}

TEST(Ply, RefusesAHeaderThatLacksOrRepeatsWhatItNeeds) {
  EXPECT_EQ(ply_error(with("float y", "float w")), "line 7: element 'vertex' has no property 'y'");
  EXPECT_EQ(ply_error(with("float y", "float x")), "line 5: property 'x' occurs twice");
  EXPECT_EQ(ply_error(with("element face", "element vertex")),
            "line 7: element 'vertex' occurs twice");
  EXPECT_EQ(ply_error(with("vertex_indices", "corners")),
            "line 9: element 'face' has no property 'vertex_indices'");
  EXPECT_EQ(ply_error(with("uchar int", "float int")),
            "line 8: a list's length must be an integer");
  EXPECT_EQ(ply_error(with("uchar int", "uchar float")),
            "line 8: 'vertex_indices' must be a list of integers");
}

TEST(Ply, RefusesRowsOfTheWrongLength) {
  EXPECT_EQ(ply_error(with("0 1.5 0", "0 1.5")), "line 12: expected 3 numbers, found 2");
  EXPECT_EQ(ply_error(with("0 1.5 0", "0 1.5 0 1")), "line 12: expected 3 numbers, found 4");
  EXPECT_EQ(ply_error(with("3 0 1 3", "3 0 1")), "line 15: expected 4 numbers, found 3");
  EXPECT_EQ(ply_error(with("3 0 1 3", "4000000000 0 1 3")),
            "line 15: expected 4000000001 numbers, found 4");
}

TEST(Ply, RefusesWhatIsNoNumber) {
  EXPECT_EQ(ply_error(with("0 1.5 0", "0 1,5 0")), "line 12: expected a number, found '1,5'");
  EXPECT_EQ(ply_error(with("3 0 1 3", "3 0 1.0 3")), "line 15: expected an integer, found '1.0'");
  EXPECT_EQ(ply_error(with("0 1.5 0", "0 nan 0")), "line 12: vertex 2: a coordinate is not finite");
}

TEST(Ply, RefusesBadFaces) {
  EXPECT_EQ(ply_error(with("3 0 1 3", "3 0 1 4")),
            "line 15: face 1: vertex index 4 is out of range: the mesh has 4 vertices");
  EXPECT_EQ(ply_error(with("3 0 1 3", "3 0 -1 3")),
            "line 15: face 1: vertex index -1 is out of range: the mesh has 4 vertices");
  EXPECT_EQ(ply_error(with("3 0 1 3", "2 0 1")),
            "line 15: face 1: expected 3 or more corners, found 2");
  EXPECT_EQ(ply_error(with("3 0 1 3", "-3 0 1 3")), "line 15: a list's length is -3");
}

TEST(Ply, NamesTheRowOfABinaryFile) {
  const std::string file = binary_ply(false);
  const std::string header = ply_header("binary_little_endian");
  std::string bad = file;
  bad.replace(header.size() + 12, 4, bytes_of(std::numeric_limits<float>::infinity()));
  EXPECT_EQ(ply_error(bad), "vertex 1: a coordinate is not finite");
  bad = file;
  bad.replace(header.size() + 4 * 12 + 13 + 1, 4, bytes_of(4));
  EXPECT_EQ(ply_error(bad), "face 1: vertex index 4 is out of range: the mesh has 4 vertices");
  bad = file;
  bad[header.size() + 4 * 12 + 13] = '\xff';
  EXPECT_EQ(ply_error(bad), "face 1: a list of 255 items, but 38 bytes follow");
}

TEST(Ply, RefusesCountsThatTheFileCannotHold) {
  EXPECT_EQ(ply_error(with("vertex 4", "vertex 4000000000")),
            "element 'vertex': 4000000000 rows of at least 6 bytes, but 62 bytes follow");
  EXPECT_EQ(ply_error(replaced(binary_ply(true), "face 4", "face 53")),
            "element 'face': 53 rows of at least 1 bytes, but 52 bytes follow");
  EXPECT_EQ(ply_error(with("face 4", "face 6")),
            "line 17: the file ends after 4 of 6 rows of 'face'");
}

TEST(Ply, RefusesDataAfterTheLastElement) {
  EXPECT_EQ(ply_error(with("face 4", "face 3")),
            "line 17: expected the end of the file, found '3'");
  EXPECT_EQ(ply_error(binary_ply(false) + "more"), "4 bytes follow the last element");
}

TEST(Ply, RefusesAFileWithoutFaces) {
  EXPECT_EQ(
      ply_error(replaced(with("face 4", "face 0"), "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", "")),
      "the mesh has no faces");
}

}  // namespace
}  // namespace pmesh
