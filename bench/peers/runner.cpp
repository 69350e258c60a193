#include "bench/peers/runner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "bench/resident_memory.h"
#include "core/base/bytes.h"
#include "core/files/atomic_file.h"
#include "core/io/clean.h"
#include "core/io/import.h"

namespace pmesh::bench {
namespace {

struct Arguments {
  std::string variant;
  std::string mesh;
  std::vector<std::string> levels;
  std::optional<std::string> prefix;
};

Arguments parse_arguments(std::string_view tool, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  Arguments arguments;
  if (words.size() >= 2 && words[words.size() - 2] == "--write") {
    arguments.prefix = words.back();
    words.resize(words.size() - 2);
  }
  if (words.size() < 3) {
    fail("usage: peer_" + std::string(tool) + " VARIANT MESH LEVEL... [--write PREFIX]");
  }
  arguments.variant = words[0];
  arguments.mesh = words[1];
  arguments.levels.assign(words.begin() + 2, words.end());
  return arguments;
}

IndexedMesh load_clean(const std::string& path) {
  Result<ImportedMesh> imported = import_mesh(path);
  if (!imported) fail(imported.error().message);
  return clean(std::move(*imported)).mesh;
}

Level parse_level(std::string_view text, std::size_t mesh_faces) {
  const bool share = text.ends_with('%');
  const std::string_view digits = text.substr(0, text.size() - (share ? 1 : 0));
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || !(number > 0)) {
    fail("not a level: " + std::string(text));
  }
  const double faces = share ? number / 100 * static_cast<double>(mesh_faces) : number;
  return {std::string(digits), static_cast<std::uint32_t>(faces)};
}

std::vector<Level> parse_levels(std::span<const std::string> texts, std::size_t mesh_faces) {
  std::vector<Level> levels;
  for (const std::string& text : texts) levels.push_back(parse_level(text, mesh_faces));
  std::stable_sort(levels.begin(), levels.end(),
                   [](const Level& a, const Level& b) { return a.faces > b.faces; });
  return levels;
}

// Binary PLY in double precision, whatever the mesh came from: the error measured is the tool's.
Bytes format_ply(const IndexedMesh& mesh) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " +
      std::to_string(mesh.positions.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nend_header\n";
  const ByteView text = as_bytes(header);
  Bytes out(text.begin(), text.end());
  ByteWriter writer(out);
  for (const Vec3d& p : mesh.positions) {
    for (const double coordinate : {p.x, p.y, p.z}) writer.put(coordinate);
  }
  for (const Triangle& triangle : mesh.triangles) {
    writer.put(std::uint8_t{3});
    for (const std::uint32_t corner : triangle) writer.put(corner);
  }
  return out;
}

// CPU time of the calling thread: other processes disturb it least.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

nlohmann::ordered_json to_json(std::span<const Lods::Written> written) {
  auto lods = nlohmann::ordered_json::array();
  for (const auto& [label, faces, file] : written) {
    lods.push_back({{"level", label}, {"faces", faces}, {"file", file}});
  }
  return lods;
}

}  // namespace

void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

IndexedMesh without_unused_vertices(const IndexedMesh& mesh) {
  IndexedMesh used;
  std::vector<std::uint32_t> numbers(mesh.positions.size(), UINT32_MAX);
  for (Triangle triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      std::uint32_t& number = numbers[corner];
      if (number == UINT32_MAX) {
        number = static_cast<std::uint32_t>(used.positions.size());
        used.positions.push_back(mesh.positions[corner]);
      }
      corner = number;
    }
    used.triangles.push_back(triangle);
  }
  return used;
}

Lods::Lods(std::vector<Level> levels, std::string prefix)
    : levels_(std::move(levels)), prefix_(std::move(prefix)) {}

void Lods::take(const IndexedMesh& mesh) {
  const std::string& label = levels_.at(next_++).label;
  const std::string file = prefix_ + "_" + label + ".ply";
  const Status status = write_file(file, format_ply(mesh), Overwrite::yes);
  if (!status) fail(status.error().message);
  written_.push_back({label, mesh.triangles.size(), file});
}

int run_peer(std::string_view tool, int argc, char** argv,
             const std::function<Peer&(const std::string& variant)>& peer) {
  const Arguments arguments = parse_arguments(tool, argc, argv);
  Peer& decimator = peer(arguments.variant);
  const std::uint64_t empty = resident_bytes();
  std::optional<IndexedMesh> mesh = load_clean(arguments.mesh);
  const std::size_t faces = mesh->triangles.size();
  const std::vector<Level> levels = parse_levels(arguments.levels, faces);
  decimator.load(*mesh);
  mesh.reset();
  const std::uint64_t loaded = resident_bytes();

  Lods lods = arguments.prefix ? Lods(levels, *arguments.prefix) : Lods();
  reset_peak();
  const double start = cpu_seconds();
  decimator.decimate(levels.back().faces, lods);
  const double seconds = cpu_seconds() - start;

  const nlohmann::ordered_json result = {{"tool", tool},
                                         {"variant", arguments.variant},
                                         {"faces", faces},
                                         {"seconds", seconds},
                                         {"mesh_bytes", loaded - std::min(loaded, empty)},
                                         {"peak_bytes", peak_resident_bytes() - loaded},
                                         {"lods", to_json(lods.written())}};
  std::printf("%s\n", result.dump().c_str());
  return 0;
}

}  // namespace pmesh::bench
