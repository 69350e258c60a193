// How fast a PM file and a Draco file of the same mesh decode on one core, in turns:
// bytes_decode_rates FILE.pmesh FILE.drc ROUNDS
//
// CPU time of the thread, from bytes in memory to a mesh in memory with all positions applied, the
// median of the rounds; pmesh's for each section of the file apart. Fails if the two meshes do not
// have the same triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <nlohmann/json.hpp>

#include "bench/bytes/programs.h"
#include "core/base/parse_number.h"
#include "core/files/read_file.h"
#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "core/precompute/quantise.h"

namespace pmesh::bench {
namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Where the sections end: prologue, base, chunks.
std::vector<std::uint64_t> section_ends(const FileIndex& index) {
  std::vector<std::uint64_t> ends{index.prologue_bytes};
  for (std::size_t c = 0; c <= index.chunks.size(); ++c) ends.push_back(index.prefix_bytes(c));
  return ends;
}

struct PmRun {
  std::vector<double> seconds;  // by section
  LatticeMesh mesh;

  double total() const {
    double sum = 0;
    for (const double s : seconds) sum += s;
    return sum;
  }
};

PmRun decode_pm(ByteView file, const std::vector<std::uint64_t>& ends) {
  StreamDecoder decoder(decode_base);
  PmRun run;
  std::uint64_t begin = 0;
  for (const std::uint64_t end : ends) {
    const double start = cpu_seconds();
    const Status fed = decoder.feed(file.subspan(begin, end - begin));
    run.seconds.push_back(cpu_seconds() - start);
    if (!fed) fail(fed.error().message);
    begin = end;
  }
  if (!decoder.complete()) fail("the PM file is not complete");
  run.mesh = decoder.mesh().snapshot();
  return run;
}

struct DracoRun {
  double seconds = 0;
  std::unique_ptr<draco::Mesh> mesh;
};

DracoRun decode_draco(ByteView file) {
  const double start = cpu_seconds();
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(file.data()), file.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  const double seconds = cpu_seconds() - start;
  if (!decoded.ok()) fail("Draco: " + decoded.status().error_msg_string());
  return {seconds, std::move(decoded).value()};
}

// Draco gives floats; in a file made of lattice coordinates they are whole numbers but for
// rounding.
LatticeMesh to_lattice(const draco::Mesh& mesh) {
  const draco::PointAttribute& positions =
      *mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  LatticeMesh lattice;
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    std::array<float, 3> at{};
    positions.GetMappedValue(p, at.data());
    const auto whole = [](float value) { return static_cast<std::int32_t>(std::lround(value)); };
    lattice.positions.push_back({whole(at[0]), whole(at[1]), whole(at[2])});
  }
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(f);
    lattice.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return lattice;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_of_section(const std::vector<PmRun>& runs, std::size_t section) {
  std::vector<double> seconds;
  for (const PmRun& run : runs) seconds.push_back(run.seconds[section]);
  return median(seconds);
}

nlohmann::json report(const FileIndex& index, const std::vector<PmRun>& pm,
                      const std::vector<double>& draco, std::size_t draco_bytes) {
  const std::vector<std::uint64_t> ends = section_ends(index);
  std::vector<double> totals;
  for (const PmRun& run : pm) totals.push_back(run.total());
  nlohmann::json sections = nlohmann::json::array();
  for (std::size_t s = 0; s < ends.size(); ++s) {
    sections.push_back({{"end", ends[s]}, {"seconds", median_of_section(pm, s)}});
  }
  const FileHeader& header = index.header;
  return {{"vertices", header.vertices},
          {"splits", header.vertices - header.base_vertices},
          {"seconds", median(totals)},
          {"sections", sections},
          {"draco", {{"bytes", draco_bytes}, {"seconds", median(draco)}}}};
}

int run(const std::string& pm_path, const std::string& draco_path, int rounds) {
  const Bytes pm_file = wanted(read_file(pm_path));
  const Bytes draco_file = wanted(read_file(draco_path));
  const std::optional<FileIndex> index = wanted(parse_prologue(pm_file));
  if (!index) fail(pm_path + ": too short");
  const std::vector<std::uint64_t> ends = section_ends(*index);
  if (!same_triangles(decode_pm(pm_file, ends).mesh, to_lattice(*decode_draco(draco_file).mesh))) {
    fail(pm_path + " and " + draco_path + ": not the same triangles");
  }
  std::vector<PmRun> pm;
  std::vector<double> draco;
  for (int round = 0; round < rounds; ++round) {
    pm.push_back(decode_pm(pm_file, ends));
    pm.back().mesh = {};
    draco.push_back(decode_draco(draco_file).seconds);
  }
  std::puts(report(*index, pm, draco, draco_file.size()).dump().c_str());
  return 0;
}

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  const auto rounds = argc == 4 ? pmesh::parse_whole<int>(argv[3]) : std::nullopt;
  if (!rounds || *rounds < 1) {
    pmesh::bench::fail("usage: bytes_decode_rates FILE.pmesh FILE.drc ROUNDS");
  }
  return pmesh::bench::run(argv[1], argv[2], *rounds);
}
