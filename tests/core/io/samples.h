// One tetrahedron (import_checks.h) as a file of every format.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "tests/core/io/import_checks.h"

namespace pmesh {

inline std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
}

inline const std::string kAsciiPly = ply_header("ascii") +
                                     "0 0 0\n1 0 0\n0 1.5 0\n0 0 -0.25\n"
                                     "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

inline std::string binary_ply(bool big_endian) {
  std::string file = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian");
  for (const Vec3d p : kCorners) {
    for (const double c : {p.x, p.y, p.z}) file += bytes_of(static_cast<float>(c), big_endian);
  }
  for (const Triangle& face : kFaces) {
    file += '\3';
    for (const std::uint32_t corner : face) file += bytes_of(corner, big_endian);
  }
  return file;
}

inline const std::string kObj =
    "# a tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1.5 0\nv 0 0 -0.25\n"
    "f 1 3 2\nf 1/1 2/2 4/3\nf 2//1 3//1 4//1\nf -2/1/1 -4/2/1 -1/3/1\n";

inline const std::string kOff =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1.5 0\n0 0 -0.25\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

inline std::string ascii_stl() {
  std::string file = "solid tetrahedron\n";
  for (const Triangle& face : kFaces) {
    file += "facet normal 0 0 1\n  outer loop\n";
    for (const std::uint32_t corner : face) {
      const Vec3d p = kCorners[corner];
      file += "    vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
              std::to_string(p.z) + "\n";
    }
    file += "  endloop\nendfacet\n";
  }
  return file + "endsolid\n";
}

inline std::string binary_stl(std::string header = "") {
  header.resize(80);
  std::string file = header + bytes_of(static_cast<std::uint32_t>(kFaces.size()));
  for (const Triangle& face : kFaces) {
    for (int i = 0; i < 3; ++i) file += bytes_of(0.0f);
    for (const std::uint32_t corner : face) {
      const Vec3d p = kCorners[corner];
      for (const double c : {p.x, p.y, p.z}) file += bytes_of(static_cast<float>(c));
    }
    file += bytes_of(std::uint16_t{0});
  }
  return file;
}

struct Sample {
  const char* name;
  MeshFormat format;
  std::string bytes;
};

inline std::vector<Sample> samples() {
  return {{"ascii PLY", MeshFormat::ply, kAsciiPly},
          {"little-endian PLY", MeshFormat::ply, binary_ply(false)},
          {"big-endian PLY", MeshFormat::ply, binary_ply(true)},
          {"OBJ", MeshFormat::obj, kObj},
          {"ascii STL", MeshFormat::stl, ascii_stl()},
          {"binary STL", MeshFormat::stl, binary_stl()},
          {"OFF", MeshFormat::off, kOff}};
}

}  // namespace pmesh
