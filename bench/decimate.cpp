// Speed, memory and the share of each phase of decimation on given mesh files, beside
// meshoptimizer's in the same run. See bench/README.md.
#include <algorithm>
#include <array>
#include <atomic>
#include <cfloat>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#ifdef PMESH_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include "bench/resident_memory.h"
#include "core/decimate/decimate.h"
#include "core/io/clean.h"
#include "core/io/import.h"
#include "core/metrics/table.h"
#include "core/precompute/sort_spatially.h"

namespace pmesh::bench {
namespace {

constexpr int kRounds = 3;

[[noreturn]] void fail(const std::string& message) {
  std::fprintf(stderr, "bench_decimate: %s\n", message.c_str());
  std::exit(1);
}

IndexedMesh load(const std::string& path) {
  Result<ImportedMesh> imported = import_mesh(path);
  if (!imported) fail(imported.error().message);
  IndexedMesh mesh = clean(std::move(*imported)).mesh;
  sort_spatially(mesh, 1);
  return mesh;
}

// "NAME" or "NAME:parameters".
AnyMetric parse_metric(std::string_view text) {
  const std::size_t colon = text.find(':');
  const Result<AnyMetric> metric = make_metric(
      text.substr(0, colon), colon == std::string_view::npos ? "" : text.substr(colon + 1));
  if (!metric) fail(metric.error().message);
  return *metric;
}

// How to decimate: metric, schedule, threads.
using Method = DecimateOptions;

Decimation decimate_by(const Method& method, HalfEdgeMesh connectivity,
                       std::vector<Vec3d> positions) {
  return decimate(std::move(connectivity), std::move(positions), method);
}

HalfEdgeMesh half_edges(const IndexedMesh& mesh) {
  auto built =
      HalfEdgeMesh::build(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()));
  if (!built) fail(built.error().message);
  return std::move(*built);
}

// CPU time of the calling thread: other processes disturb it least.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double seconds_of(const Work& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

template <class Work>
double wall_seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Times {
  double build = DBL_MAX;        // half-edges from triangles
  double decimate = DBL_MAX;     // from half-edges to the base, the whole log
  double peer = DBL_MAX;         // meshoptimizer to 1%, one level of detail
  double wall = DBL_MAX;         // decimate again, by the clock on the wall
  double wall_of_two = DBL_MAX;  // with two threads
  std::uint32_t base_faces = 0;
};

#ifdef PMESH_HAS_MESHOPTIMIZER
double time_peer(const IndexedMesh& mesh) {
  std::vector<float> positions;
  for (const Vec3d& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z}) positions.push_back(static_cast<float>(x));
  }
  std::vector<unsigned> indices;
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  std::vector<unsigned> simplified(indices.size());
  return seconds_of([&] {
    meshopt_simplify(simplified.data(), indices.data(), indices.size(), positions.data(),
                     mesh.positions.size(), 3 * sizeof(float), indices.size() / 300 * 3, FLT_MAX, 0,
                     nullptr);
  });
}
#else
double time_peer(const IndexedMesh&) { return DBL_MAX; }
#endif

void fail_unless_same(const CollapseLog& a, const CollapseLog& b) {
  const auto same = [](const HalfEdgeCollapse& c, const HalfEdgeCollapse& d) {
    return c.removed == d.removed && c.kept == d.kept;
  };
  if (a.batch_ends != b.batch_ends || !std::ranges::equal(a.collapses, b.collapses, same)) {
    fail("two threads made another log than one");
  }
}

// The best of some rounds in turn.
Times measure_times(const IndexedMesh& mesh, Method method) {
  Times best;
  const auto improve = [](double& time, double seconds) { time = std::min(time, seconds); };
  for (int round = 0; round < kRounds; ++round) {
    improve(best.peer, time_peer(mesh));
    HalfEdgeMesh connectivity;
    improve(best.build, seconds_of([&] { connectivity = half_edges(mesh); }));
    std::optional<Decimation> one, two;
    HalfEdgeMesh copy = connectivity;
    std::vector<Vec3d> positions = mesh.positions;
    const auto run = [&](unsigned threads) {
      method.threads = threads;
      return decimate_by(method, std::move(copy), std::move(positions));
    };
    improve(best.wall,
            wall_seconds_of([&] { improve(best.decimate, seconds_of([&] { one = run(1); })); }));
    copy = std::move(connectivity);
    positions = mesh.positions;
    improve(best.wall_of_two, wall_seconds_of([&] { two = run(2); }));
    fail_unless_same(one->log, two->log);
    best.base_faces = one->report.faces;
  }
  return best;
}

// The share of samples that found decimation in each phase.
std::array<double, kDecimationPhases> measure_phases(const IndexedMesh& mesh, Method method) {
  std::array<double, kDecimationPhases> shares{};
  HalfEdgeMesh connectivity = half_edges(mesh);
  std::atomic<DecimationPhase> phase = DecimationPhase::evaluate_all;
  std::jthread sampler([&](const std::stop_token& stop) {
    double samples = 0;
    while (!stop.stop_requested()) {
      ++shares[static_cast<std::size_t>(phase.load(std::memory_order_relaxed))];
      ++samples;
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    for (double& share : shares) share /= samples;
  });
  method.phase = &phase;
  static_cast<void>(decimate_by(method, std::move(connectivity), mesh.positions));
  sampler.request_stop();
  sampler.join();
  return shares;
}

struct Memory {
  double mesh = 0;   // half-edge mesh, bytes a face
  double above = 0;  // peak above half-edge mesh and positions, bytes a face
};

Memory measure_memory_here(const std::string& path, const Method& method) {
  IndexedMesh mesh = load(path);
  const double faces = static_cast<double>(mesh.triangles.size());
  const std::uint64_t before = resident_bytes();
  HalfEdgeMesh connectivity = half_edges(mesh);
  const std::uint64_t with_mesh = resident_bytes();
  mesh.triangles = {};
  const std::uint64_t baseline = resident_bytes();
  reset_peak();
  static_cast<void>(decimate_by(method, std::move(connectivity), std::move(mesh.positions)));
  const std::uint64_t peak = peak_resident_bytes();
  return {static_cast<double>(with_mesh - before) / faces,
          static_cast<double>(peak - baseline) / faces};
}

// In a process of its own, so that memory left over from other measurements does not hide any.
Memory measure_memory(const std::string& path, const Method& method) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) fail("no pipe");
  const pid_t child = fork();
  if (child < 0) fail("no process");
  Memory memory;
  if (child == 0) {
    memory = measure_memory_here(path, method);
    _exit(write(ends[1], &memory, sizeof memory) == sizeof memory ? 0 : 1);
  }
  close(ends[1]);
  if (read(ends[0], &memory, sizeof memory) != sizeof memory) fail("no memory measured");
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return memory;
}

void print_header() {
  std::printf("| %-20s | %-20s | %8s | %5s | %7s | %7s | %7s | %5s | %5s | %6s | %6s |", "mesh",
              "metric", "faces", "base", "pmesh", "+ build", "meshopt", "ratio", "two", "mesh B",
              "peak B");
  for (const char* phase : {"all", "choose", "gather", "cost", "legal", "commit"}) {
    std::printf(" %6s |", phase);
  }
  std::printf(
      "\n|----------------------|----------------------|---------:|------:|--------:|--------:|----"
      "----:|------:|------:|"
      "-------:|-------:|-------:|-------:|-------:|-------:|-------:|-------:|\n");
}

void print_row(const std::string& path, const std::string& metric, std::size_t face_count,
               const Times& times, const Memory& memory,
               const std::array<double, kDecimationPhases>& phases) {
  const double faces = static_cast<double>(face_count);
  std::printf("| %-20s | %-20s | %8zu | %5u | %7.0f | %7.0f |",
              path.substr(path.find_last_of('/') + 1).c_str(), metric.c_str(), face_count,
              times.base_faces, faces / times.decimate / 1000,
              faces / (times.decimate + times.build) / 1000);
  if (times.peer < DBL_MAX) {
    std::printf(" %7.0f | %5.2f |", faces / times.peer / 1000, times.decimate / times.peer);
  } else {
    std::printf(" %7s | %5s |", "-", "-");
  }
  std::printf(" %5.2f |", times.wall / times.wall_of_two);
  std::printf(" %6.1f | %6.1f |", memory.mesh, memory.above);
  for (const double share : phases) std::printf(" %5.1f%% |", 100 * share);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace pmesh::bench

int main(int argc, char** argv) {
  using namespace pmesh::bench;
  constexpr const char* kUsage =
      "usage: bench_decimate [--exact] [--metric NAME[:PARAMETERS]]... MESH...";
  std::vector<std::string> metrics, meshes;
  Method method;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--exact") {
      method.schedule = pmesh::Schedule::exact;
    } else if (std::string_view(argv[i]) != "--metric") {
      meshes.emplace_back(argv[i]);
    } else if (++i < argc) {
      metrics.emplace_back(argv[i]);
    } else {
      fail(kUsage);
    }
  }
  if (meshes.empty()) fail(kUsage);
  if (metrics.empty()) metrics.emplace_back(pmesh::metric_table().front().name);
#ifndef PMESH_HAS_MESHOPTIMIZER
  std::printf("meshoptimizer was not found when this was built: no comparison\n");
#endif
  print_header();
  for (const std::string& path : meshes) {
    for (const std::string& name : metrics) {
      method.metric = parse_metric(name);
      const Memory memory = measure_memory(path, method);
      const pmesh::IndexedMesh mesh = load(path);
      print_row(path, name, mesh.triangles.size(), measure_times(mesh, method), memory,
                measure_phases(mesh, method));
    }
  }
}
