// pmesh compare: how far two surfaces are apart, as Metro measures it.
#include "core/measure/compare.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/json.h"
#include "cli/verb.h"
#include "core/files/out_of_memory.h"
#include "core/io/import.h"
#include "core/pm/pm_file.h"

namespace pmesh::cli {
namespace {

struct Options {
  std::string a, b;
  CompareOptions compare;
  bool json = false;
};

// The finest LOD that the PM file at `path` holds.
Result<IndexedMesh> decode_finest(const std::string& path) {
  const Result<PmFile> file = PmFile::open(path);
  if (!file) return file.error();
  const Result<RefinableMesh> decoded = file->decode(file->whole_chunks());
  if (!decoded) return prefixed(path, decoded.error());
  LatticeMesh lod = decoded->snapshot();
  IndexedMesh mesh;
  mesh.positions.resize(lod.positions.size());
  std::transform(lod.positions.begin(), lod.positions.end(), mesh.positions.begin(),
                 [&](Vec3i p) { return file->index().header.lattice.position(p); });
  mesh.triangles = std::move(lod.triangles);
  return mesh;
}

Result<IndexedMesh> read_mesh(const std::string& path) {
  if (path.ends_with(".pmesh")) return decode_finest(path);
  Result<ImportedMesh> imported = import_mesh(path);
  if (!imported) return imported.error();
  return std::move(imported->mesh);
}

Result<Comparison> compare_files(const Options& options) {
  const Result<IndexedMesh> a = read_mesh(options.a);
  if (!a) return a.error();
  const Result<IndexedMesh> b = read_mesh(options.b);
  if (!b) return b.error();
  Result<Comparison> comparison = compare_surfaces(*a, *b, options.compare);
  if (!comparison) return prefixed(options.a + ", " + options.b, comparison.error());
  return comparison;
}

// Both meshes in one point have no size to relate a distance to: then 0 stands for no distance.
double relative(double distance, const Comparison& comparison) {
  return distance == 0 ? 0 : distance / comparison.bbox_diagonal;
}

Json to_json(const SurfaceDistance& distance) {
  return {{"max", distance.max}, {"mean", distance.mean}, {"rms", distance.rms}};
}

Json to_json(const Options& options, const Comparison& comparison) {
  return {{"a", options.a},
          {"b", options.b},
          {"bbox_diagonal", comparison.bbox_diagonal},
          {"forward", to_json(comparison.forward)},
          {"backward", to_json(comparison.backward)},
          {"max", comparison.max()},
          {"rms", comparison.rms()},
          {"max_relative", relative(comparison.max(), comparison)},
          {"rms_relative", relative(comparison.rms(), comparison)},
          {"samples", options.compare.samples},
          {"seed", options.compare.seed}};
}

void print_text(const Options& options, const Comparison& comparison) {
  const auto print_row = [](const char* name, const SurfaceDistance& distance) {
    std::printf("%-10s %12.6g %12.6g %12.6g\n", name, distance.max, distance.mean, distance.rms);
  };
  std::printf("A: %s\nB: %s\n", options.a.c_str(), options.b.c_str());
  std::printf("%-10s %12s %12s %12s\n", "", "max", "mean", "rms");
  print_row("A to B", comparison.forward);
  print_row("B to A", comparison.backward);
  std::printf("larger: max %.6g, rms %.6g; of A's diagonal %.6g: max %.6g %%, rms %.6g %%\n",
              comparison.max(), comparison.rms(), comparison.bbox_diagonal,
              100 * relative(comparison.max(), comparison),
              100 * relative(comparison.rms(), comparison));
}

int run_compare(const Options& options) {
  const Result<Comparison> comparison =
      catching_out_of_memory([&] { return compare_files(options); });
  if (!comparison) return report("compare", comparison.error());
  if (options.json) {
    print_json(to_json(options, *comparison));
  } else {
    print_text(options, *comparison);
  }
  return kExitOk;
}

}  // namespace

void add_compare(CLI::App& app, int& exit_status) {
  auto options = std::make_shared<Options>();
  CompareOptions& compare = options->compare;
  compare.threads = std::max(1u, std::thread::hardware_concurrency());
  CLI::App* verb = app.add_subcommand("compare", "Measure how far two surfaces are apart");
  verb->add_option("A", options->a,
                   "Mesh file (.ply, .obj, .stl, .off) or PM file (its finest LOD)")
      ->required();
  verb->add_option("B", options->b, "The same")->required();
  verb->add_option("--samples", compare.samples,
                   "Points to look at a direction, besides all vertices")
      ->check(CLI::Range(1000u, 1'000'000'000u))
      ->capture_default_str();
  verb->add_option("--seed", compare.seed, "Chooses the points")->capture_default_str();
  verb->add_option("--threads", compare.threads, "Threads; the result does not depend on it")
      ->check(CLI::Range(1u, 1024u))
      ->capture_default_str();
  verb->add_flag("--json", options->json, "Print one JSON object");
  verb->callback([options, &exit_status] { exit_status = run_compare(*options); });
}

}  // namespace pmesh::cli
