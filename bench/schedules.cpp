// The batched schedule of decimation beside the exact one of the same metric: the error at the same
// number of faces, at the ends of batches and inside them. See bench/README.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "core/decimate/decimate.h"
#include "core/io/clean.h"
#include "core/io/import.h"
#include "core/measure/compare.h"
#include "core/metrics/table.h"
#include "core/precompute/sort_spatially.h"

namespace pmesh::bench {
namespace {

constexpr std::array kLevels = {0.5, 0.25, 0.1, 0.05, 0.02, 0.01, 0.005};  // of the faces
constexpr double kNegligible = 2e-5;  // an error's difference, of the diagonal

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "bench_schedules: %s\n", message.c_str());
  std::exit(1);
}

IndexedMesh load(const std::string& path) {
  Result<ImportedMesh> imported = import_mesh(path);
  if (!imported) fail(imported.error().message);
  IndexedMesh mesh = clean(std::move(*imported)).mesh;
  sort_spatially(mesh, 2);
  return mesh;
}

Decimation decimated(const IndexedMesh& mesh, const AnyMetric& metric, Schedule schedule) {
  DecimateOptions options;
  options.metric = metric;
  options.schedule = schedule;
  options.base_faces =
      static_cast<std::uint32_t>(kLevels.back() * static_cast<double>(mesh.triangles.size()));
  auto built =
      HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
  if (!built) fail(built.error().message);
  return decimate(std::move(*built), mesh.positions, options);
}

// By the number of collapses made: the faces that are left.
std::vector<std::uint32_t> faces_left(const IndexedMesh& mesh, const CollapseLog& log) {
  std::vector<std::uint32_t> faces = {static_cast<std::uint32_t>(mesh.triangles.size())};
  for (const HalfEdgeCollapse& c : log.collapses) {
    faces.push_back(faces.back() - static_cast<std::uint32_t>(c.removed_faces()));
  }
  return faces;
}

// The first state of at most `target` faces, steps being whole.
std::uint32_t collapses_to(const std::vector<std::uint32_t>& faces, std::uint32_t target,
                           std::uint32_t per_step) {
  std::uint32_t count = 0;
  while (faces[count] > target && count + per_step < faces.size()) count += per_step;
  return count;
}

IndexedMesh lod(const IndexedMesh& mesh, const Decimation& decimation, std::size_t count) {
  const CollapseLog& log = decimation.log;
  IndexedMesh result{decimation.positions, {}};
  for (std::size_t i = log.kept_before.size(); i-- > count;) {
    result.positions[log.collapses[i].kept.value] = log.kept_before[i];
  }
  std::vector<std::uint32_t> became(mesh.positions.size());
  std::iota(became.begin(), became.end(), 0);
  for (std::size_t i = count; i-- > 0;) {
    became[log.collapses[i].removed.value] = became[log.collapses[i].kept.value];
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t = {became[a], became[b], became[c]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

class Comparer {
 public:
  Comparer(const IndexedMesh& mesh, const AnyMetric& metric, std::uint32_t samples)
      : mesh_(mesh),
        samples_(samples),
        batched_(decimated(mesh, metric, Schedule::batched)),
        exact_(decimated(mesh, metric, Schedule::exact)),
        batched_faces_(faces_left(mesh, batched_.log)),
        exact_faces_(faces_left(mesh, exact_.log)) {}

  // Batched over exact RMS at the batched schedule's state after `count` collapses.
  double ratio(std::uint32_t count) const {
    const double batched = rms(batched_, count);
    const double exact = rms(
        exact_, collapses_to(exact_faces_, batched_faces_[count], exact_.log.collapses_per_step));
    return std::abs(batched - exact) < kNegligible ? 1 : batched / exact;
  }

  std::uint32_t state_at(double level) const {
    const double target = level * static_cast<double>(mesh_.triangles.size());
    return collapses_to(batched_faces_, static_cast<std::uint32_t>(target),
                        batched_.log.collapses_per_step);
  }

  // The end of a batch that is nearest to that state.
  std::uint32_t end_near(std::uint32_t count) const {
    const auto& ends = batched_.log.batch_ends;
    const auto next = std::lower_bound(ends.begin(), ends.end(), count);
    if (next == ends.end()) return ends.back();
    if (next == ends.begin()) return *next;
    const double faces = batched_faces_[count];
    return batched_faces_[next[-1]] / faces < faces / batched_faces_[*next] ? next[-1] : *next;
  }

  // Bits a vertex that it takes to say which of the vertices of each batch's end are split.
  double mark_bits() const {
    double bits = 0;
    double vertices = static_cast<double>(mesh_.positions.size());
    std::uint32_t before = 0;
    for (const std::uint32_t end : batched_.log.batch_ends) {
      vertices -= end - before;
      const double p = (end - before) / vertices;
      bits -= vertices * (p * std::log2(p) + (1 - p) * std::log2(1 - p));
      before = end;
    }
    return bits / static_cast<double>(batched_.log.collapses.size());
  }

  // Of the vertices, geometric mean.
  double mean_share() const {
    const double left = static_cast<double>(mesh_.positions.size() - batched_.log.collapses.size());
    const double all = static_cast<double>(mesh_.positions.size());
    return 1 - std::pow(left / all, 1.0 / static_cast<double>(batched_.log.batch_ends.size()));
  }
  std::size_t batches() const { return batched_.log.batch_ends.size(); }

 private:
  double rms(const Decimation& decimation, std::uint32_t count) const {
    CompareOptions options;
    options.samples = samples_;
    options.threads = 2;
    const auto compared = compare_surfaces(mesh_, lod(mesh_, decimation, count), options);
    if (!compared) fail(compared.error().message);
    return compared->rms() / compared->bbox_diagonal;
  }

  const IndexedMesh& mesh_;
  std::uint32_t samples_;
  Decimation batched_, exact_;
  std::vector<std::uint32_t> batched_faces_, exact_faces_;
};

struct Mean {
  double logarithms = 0, worst = 0;
  int count = 0;
  void add(double ratio) {
    if (ratio == 1) return;  // negligible
    logarithms += std::log(ratio);
    worst = std::max(worst, ratio);
    ++count;
  }
  double mean() const { return std::exp(logarithms / std::max(count, 1)); }
};

void compare_schedules(const std::vector<std::string>& paths, const std::string& name,
                       std::uint32_t samples) {
  const std::size_t colon = name.find(':');
  const Result<AnyMetric> metric =
      make_metric(name.substr(0, colon), colon == std::string::npos ? "" : name.substr(colon + 1));
  if (!metric) fail(metric.error().message);
  Mean ends, inside, marks;
  for (const std::string& path : paths) {
    const IndexedMesh mesh = load(path);
    const Comparer comparer(mesh, *metric, samples);
    std::printf("| %-20s | %-14s | %3zu | %4.1f%% | %.2f |",
                path.substr(path.find_last_of('/') + 1).c_str(), name.c_str(), comparer.batches(),
                100 * comparer.mean_share(), comparer.mark_bits());
    marks.add(comparer.mark_bits());
    for (const double level : kLevels) {
      const std::uint32_t state = comparer.state_at(level);
      const double at_end = comparer.ratio(comparer.end_near(state));
      const double at_level = comparer.ratio(state);
      ends.add(at_end);
      inside.add(at_level);
      std::printf(" %.2f %.2f |", at_end, at_level);
      std::fflush(stdout);
    }
    std::printf("\n");
  }
  std::printf("%s: ends mean %.3f, worst %.3f; inside mean %.3f, worst %.3f; marks %.3f\n",
              name.c_str(), ends.mean(), ends.worst, inside.mean(), inside.worst, marks.mean());
}

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh::bench;
  std::vector<std::string> metrics, meshes;
  std::uint32_t samples = 200'000;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--metric" && i + 1 < argc) {
      metrics.emplace_back(argv[++i]);
    } else if (argument == "--samples" && i + 1 < argc) {
      samples = static_cast<std::uint32_t>(std::atoi(argv[++i]));
    } else {
      meshes.emplace_back(argv[i]);
    }
  }
  if (metrics.empty()) metrics.emplace_back(pmesh::metric_table().front().name);
  for (const std::string& metric : metrics) compare_schedules(meshes, metric, samples);
}
