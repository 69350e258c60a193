// The full mesh of a PM file in lattice coordinates, as a PLY file that Draco quantises to just the
// same integers: bytes_lattice_mesh IN.pmesh OUT.ply
//
// Draco's `-qp BITS` maps the longest side to 2^BITS - 1 steps, as the lattice does, so whole
// numbers stay what they are. But its reader welds equal positions, which would change the mesh:
// vertices that share a lattice point are moved by fractions of a step that rounding takes away.
#include <bit>
#include <cstdio>
#include <map>
#include <string>
#include <tuple>

#include <nlohmann/json.hpp>

#include "bench/bytes/programs.h"
#include "core/base/box.h"
#include "core/base/bytes.h"
#include "core/files/atomic_file.h"
#include "core/pm/pm_file.h"

namespace pmesh::bench {
namespace {

constexpr int kMostBits = 16;  // so that a float holds a coordinate and its fraction
constexpr int kParts = 32;     // a fraction is one of 0 to 31 parts of 1/128 of a step

struct Distinct {
  std::vector<Vec3<float>> positions;
  std::size_t coincident = 0;  // vertices that share their lattice point with an earlier one
};

// Away from the nearer end of an axis, so that the bounding box stays.
float moved(std::int32_t coordinate, int parts, std::int32_t last) {
  const float fraction = static_cast<float>(parts) / (4 * kParts);
  return static_cast<float>(coordinate) + (coordinate < last / 2 ? fraction : -fraction);
}

Distinct distinct_positions(const std::vector<Vec3i>& points, std::int32_t last) {
  std::map<std::tuple<int, int, int>, int> seen;
  Distinct distinct;
  for (const Vec3i p : points) {
    const int copy = seen[{p.x, p.y, p.z}]++;
    if (copy > 0) ++distinct.coincident;
    if (copy >= kParts * kParts * kParts) fail("too many vertices share a lattice point");
    distinct.positions.push_back({moved(p.x, copy % kParts, last),
                                  moved(p.y, copy / kParts % kParts, last),
                                  moved(p.z, copy / kParts / kParts, last)});
  }
  return distinct;
}

void check_span(const LatticeMesh& mesh, const Lattice& lattice) {
  const Box<std::int32_t> box = bounding_box(std::span(mesh.positions));
  if (lattice.bits > kMostBits) fail("more than 16 bits a coordinate");
  if (box.low != Vec3i{} || box.longest_side() != (1 << lattice.bits) - 1) {
    fail("the full mesh does not span its lattice: Draco would quantise it otherwise");
  }
}

Bytes to_ply(const std::vector<Vec3<float>>& positions, const std::vector<Triangle>& triangles) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  Bytes bytes(header.begin(), header.end());
  ByteWriter writer(bytes);
  for (const Vec3<float>& p : positions) {
    for (const float value : {p.x, p.y, p.z}) writer.put(std::bit_cast<std::uint32_t>(value));
  }
  for (const Triangle& t : triangles) {
    writer.put(std::uint8_t{3});
    for (const std::uint32_t corner : t) writer.put(corner);
  }
  return bytes;
}

int run(const std::string& in, const std::string& out) {
  const PmFile file = wanted(PmFile::open(in));
  const Lattice& lattice = file.index().header.lattice;
  const LatticeMesh full = wanted(file.decode(file.whole_chunks())).snapshot();
  check_span(full, lattice);
  const Distinct distinct = distinct_positions(full.positions, (1 << lattice.bits) - 1);
  const Status written =
      write_file(out, to_ply(distinct.positions, full.triangles), Overwrite::yes);
  if (!written) fail(written.error().message);
  std::puts(nlohmann::json{{"vertices", full.positions.size()},
                           {"faces", full.triangles.size()},
                           {"bits", lattice.bits},
                           {"coincident", distinct.coincident}}
                .dump()
                .c_str());
  return 0;
}

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  if (argc != 3) pmesh::bench::fail("usage: bytes_lattice_mesh IN.pmesh OUT.ply");
  return pmesh::bench::run(argv[1], argv[2]);
}
