#include <gtest/gtest.h>

#include "tests/core/io/samples.h"

namespace pmesh {
namespace {

ImportedMesh stl(const std::string& bytes) { return parsed(MeshFormat::stl, bytes); }
std::string stl_error(const std::string& bytes) { return error_of(MeshFormat::stl, bytes); }

void expect_soup(const ImportedMesh& imported) {
  EXPECT_TRUE(imported.is_soup);
  EXPECT_EQ(imported.mesh.positions.size(), 3 * kFaces.size());
  ASSERT_EQ(imported.mesh.triangles.size(), kFaces.size());
  for (std::size_t f = 0; f < kFaces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(imported.mesh.triangles[f][k], 3 * f + k);
      EXPECT_EQ(imported.mesh.positions[3 * f + k], kCorners[kFaces[f][k]]);
    }
  }
}

TEST(Stl, ReadsTextAndBinary) {
  expect_soup(stl(ascii_stl()));
  expect_soup(stl(binary_stl()));
}

TEST(Stl, TellsBinaryFromTextBySize) { expect_soup(stl(binary_stl("solid by a confusing tool"))); }

TEST(Stl, TakesAnyCaseAndLineEnd) {
  expect_soup(stl(replaced(ascii_stl(), "\n", "\r\n")));
  expect_soup(stl(replaced(replaced(ascii_stl(), "facet", "FACET"), "vertex", "Vertex")));
  expect_soup(stl(ascii_stl().substr(0, ascii_stl().size() - 1)));
}

TEST(Stl, TakesSeveralSolids) {
  EXPECT_EQ(stl(ascii_stl() + "solid\nendsolid\n" + ascii_stl()).mesh.triangles.size(), 8u);
}

TEST(Stl, TakesPadding) { expect_soup(stl(binary_stl() + std::string(5, '\0'))); }

TEST(Stl, RefusesCountsThatDoNotFit) {
  const std::string file = binary_stl();
  EXPECT_EQ(stl_error(file.substr(0, file.size() - 1)),
            "the header claims 4 triangles of 50 bytes, but 199 bytes follow");
  std::string lying = file;
  lying.replace(80, 4, bytes_of(4'000'000'000u));
  EXPECT_EQ(stl_error(lying),
            "the header claims 4000000000 triangles of 50 bytes, but 200 bytes follow");
  lying.replace(80, 4, bytes_of(0));
  EXPECT_EQ(stl_error(file + lying.substr(84)),
            "the header claims 4 triangles of 50 bytes, but 400 bytes follow");
}

TEST(Stl, RefusesAShortHeader) {
  EXPECT_EQ(stl_error(""), "expected 84 bytes of header, found 0");
  EXPECT_EQ(stl_error("lump of clay"), "expected 84 bytes of header, found 12");
}

TEST(Stl, ReportsACutBinaryFileAsSuchThoughItBeginsAsText) {
  const std::string file = binary_stl("solid");
  EXPECT_EQ(stl_error(file.substr(0, 100)),
            "the header claims 4 triangles of 50 bytes, but 16 bytes follow");
}

TEST(Stl, RefusesCoordinatesThatAreNotFinite) {
  std::string file = binary_stl();
  file.replace(84 + 50 + 12, 4, bytes_of(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(stl_error(file), "triangle 1: a coordinate is not finite");
  EXPECT_EQ(stl_error(replaced(ascii_stl(), "-0.250000", "-inf")),
            "line 13: the coordinate '-inf' is not finite");
}

TEST(Stl, RefusesMalformedText) {
  EXPECT_EQ(stl_error(replaced(ascii_stl(), "vertex 1.000000", "vertex")),
            "line 6: expected 3 numbers, found 2");
  EXPECT_EQ(stl_error("solid\nouter loop\n"), "line 2: unexpected 'outer'");
  EXPECT_EQ(stl_error("solid\nfacet\nouter loop\nvertex 0 0 0\nendloop\n"),
            "line 5: expected 3 corners, found 1");
  EXPECT_EQ(stl_error("solid\nfacet\nnonsense\n"), "line 3: unexpected 'nonsense'");
  EXPECT_EQ(stl_error("solid\nfacet\n"), "line 2: the file ends before 'endsolid'");
  EXPECT_EQ(stl_error("solid\nendsolid\n"), "the mesh has no faces");
}

}  // namespace
}  // namespace pmesh
