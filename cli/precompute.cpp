// pmesh precompute: mesh file in, PM file out, and a report of all that was done to it.
#include "core/precompute/precompute.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <thread>

#include <CLI/CLI.hpp>
#include <sys/resource.h>

#include "cli/check_distinct.h"
#include "cli/exit_codes.h"
#include "cli/json.h"
#include "cli/progress_bar.h"
#include "cli/verb.h"
#include "core/base/parse_number.h"
#include "core/metrics/table.h"

namespace pmesh::cli {
namespace {

struct Options {
  PrecomputeOptions precompute;
  std::map<std::string, std::string> metric_parameters;  // by name, of those given
  bool no_measure = false;
  bool force = false;
  bool json = false;
  bool quiet = false;
};

const std::map<std::string, Schedule> kSchedules = {{"batched", Schedule::batched},
                                                    {"exact", Schedule::exact}};

// Seconds spent in each phase.
class PhaseClock {
 public:
  void enter(PrecomputePhase phase) {
    if (phase == phase_) return;
    const auto now = Clock::now();
    seconds_[static_cast<std::size_t>(phase_)] += since(entered_, now);
    phase_ = phase;
    entered_ = now;
  }

  double seconds(PrecomputePhase phase) const { return seconds_[static_cast<std::size_t>(phase)]; }
  double total() const { return since(started_, Clock::now()); }

  static const char* name(PrecomputePhase phase) {
    constexpr std::array kNames = {"import",  "clean", "decimate", "encode",
                                   "measure", "write", "done"};
    return kNames[static_cast<std::size_t>(phase)];
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double since(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  }

  PrecomputePhase phase_ = PrecomputePhase::import;
  Clock::time_point started_ = Clock::now();
  Clock::time_point entered_ = started_;
  std::array<double, 7> seconds_{};
};

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

Json to_json(const CleanReport& cleaned) {
  return {{"degenerate", cleaned.degenerate},
          {"duplicate", cleaned.duplicate},
          {"welded", cleaned.welded},
          {"unreferenced", cleaned.unreferenced},
          {"opposite_pairs", cleaned.opposite_pairs},
          {"nonmanifold_edges_cut", cleaned.nonmanifold_edges_cut},
          {"winding_edges_cut", cleaned.winding_edges_cut},
          {"nonmanifold_vertices_cut", cleaned.nonmanifold_vertices_cut},
          {"vertices_added", cleaned.vertices_added}};
}

Json optional_json(const std::optional<std::uint64_t>& count) {
  return count ? Json(*count) : Json(nullptr);
}

Json seconds_json(const PhaseClock& clock) {
  Json seconds;
  for (const PrecomputePhase phase :
       {PrecomputePhase::import, PrecomputePhase::clean, PrecomputePhase::decimate,
        PrecomputePhase::encode, PrecomputePhase::measure, PrecomputePhase::write}) {
    seconds[PhaseClock::name(phase)] = clock.seconds(phase);
  }
  seconds["total"] = clock.total();
  return seconds;
}

Json to_json(const Options& options, const PrecomputeReport& report, const PhaseClock& clock) {
  return {{"input", options.precompute.input},
          {"output", options.precompute.output},
          {"input_faces", report.input_faces},
          {"input_vertices", report.input_vertices},
          {"polygons", report.polygons},
          {"cleaned", to_json(report.cleaned)},
          {"faces", report.faces},
          {"vertices", report.vertices},
          {"metric", options.precompute.metric},
          {"parameters", report.metric_parameters},
          {"base_faces", report.base_faces},
          {"base_vertices", report.base_vertices},
          {"base_bytes", report.base_bytes},
          {"planarity_relaxed_at", optional_json(report.planarity_relaxed_at)},
          {"fold_over_relaxed_at", optional_json(report.fold_over_relaxed_at)},
          {"errors_measured", report.measured},
          {"largest_valence", report.largest_valence},
          {"quantization", report.lattice.bits},
          {"step", report.lattice.step},
          {"chunks", report.chunks},
          {"file_bytes", report.file_bytes},
          {"hash", report.hash},
          {"seconds", seconds_json(clock)},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

void print_count(std::uint64_t count, const char* what) {
  if (count > 0) std::printf("  %llu %s\n", static_cast<unsigned long long>(count), what);
}

void print_text(const Options& options, const PrecomputeReport& report, const PhaseClock& clock) {
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  const CleanReport& cleaned = report.cleaned;
  std::printf("%s: %llu faces, %llu vertices\n", options.precompute.input.c_str(),
              number(report.input_faces), number(report.input_vertices));
  print_count(report.polygons, "polygons cut into fans of triangles");
  print_count(cleaned.degenerate, "faces dropped that repeat a vertex");
  print_count(cleaned.duplicate, "faces dropped as copies of another");
  print_count(cleaned.unreferenced, "vertices dropped that no face uses");
  print_count(cleaned.welded, "vertices welded");
  print_count(cleaned.opposite_pairs, "pairs of opposite faces kept as two sheets");
  print_count(cleaned.nonmanifold_edges_cut, "edges of more than two faces cut");
  print_count(cleaned.winding_edges_cut, "edges cut whose faces disagree in orientation");
  print_count(cleaned.nonmanifold_vertices_cut, "vertices with more than one fan cut");
  if (cleaned.vertices_added > 0) {
    std::printf("  %llu vertices added by cuts; cut borders may open at coarse levels of detail\n",
                number(cleaned.vertices_added));
  }
  std::printf("full mesh: %llu faces, %llu vertices, %d bits (step %.4g)\n", number(report.faces),
              number(report.vertices), report.lattice.bits, report.lattice.step);
  std::printf("base mesh: %llu faces, %llu bytes\n", number(report.base_faces),
              number(report.base_bytes));
  if (report.planarity_relaxed_at) {
    std::printf("  the planar test was given up below %llu faces\n",
                number(*report.planarity_relaxed_at));
  }
  if (report.fold_over_relaxed_at) {
    std::printf("  the fold-over check was relaxed below %llu faces\n",
                number(*report.fold_over_relaxed_at));
  }
  if (options.precompute.measure && !report.measured) {
    std::printf("errors not measured: a vertex has %u faces\n", report.largest_valence);
  }
  std::printf("%s: %llu bytes in %zu chunks, hash %s, %.2f s\n", options.precompute.output.c_str(),
              number(report.file_bytes), report.chunks, report.hash.c_str(), clock.total());
}

// As make_metric() takes them.
std::string joined(const std::map<std::string, std::string>& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) {
    if (!text.empty()) text += ',';
    text += name;
    if (!value.empty()) text += '=' + value;
  }
  return text;
}

// --metric, and an option for every parameter that a metric has.
void add_metric_options(CLI::App& verb, Options& options) {
  std::string help = "Decimation metric:";
  for (const MetricRow& row : metric_table()) {
    help += "\n  " + std::string(row.name) + ": " + std::string(row.summary);
  }
  verb.add_option("--metric", options.precompute.metric, help)->capture_default_str();
  for (const MetricParameter& parameter : parameter_table()) {
    const std::string name(parameter.name), help_text(parameter.help);
    if (parameter.kind == ParameterKind::flag) {
      verb.add_flag_callback(
          "--" + name, [&options, name] { options.metric_parameters[name]; }, help_text);
      continue;
    }
    verb.add_option_function<std::string>(
            "--" + name,
            [&options, name](const std::string& value) { options.metric_parameters[name] = value; },
            help_text)
        ->type_name(parameter.kind == ParameterKind::number ? "NUMBER"
                                                            : std::string(parameter.values));
  }
}

// CLI11's own ranges let NaN pass.
std::string check_tolerance(const std::string& text) {
  const std::optional<double> length = parse_whole<double>(text);
  const bool fine = length && std::isfinite(*length) && *length > 0;
  return fine ? std::string() : "expected a length above 0, not " + text;
}

void add_precision_options(CLI::App& verb, Precision& precision) {
  CLI::Option* bits = verb.add_option("--quantization", precision.bits,
                                      "Bits a coordinate; default: a step of at most 1/24 of the "
                                      "median edge, 10 to 20 bits");
  bits->check(CLI::Range(kMinLatticeBits, kMaxLatticeBits));
  verb.add_option("--tolerance", precision.tolerance,
                  "Instead, the most that a coordinate may move, in the mesh's units")
      ->type_name("LENGTH")
      ->check(check_tolerance)
      ->excludes(bits);
}

int run_precompute(Options& options) {
  options.precompute.metric_parameters = joined(options.metric_parameters);
  options.precompute.measure = !options.no_measure;
  options.precompute.overwrite = options.force ? Overwrite::yes : Overwrite::no;
  const PrecomputeOptions& job = options.precompute;
  if (Status distinct = check_distinct(job.input, job.output); !distinct) {
    return report("precompute", distinct.error());
  }
  PhaseClock clock;
  ProgressBar bar(!options.quiet && !options.json);
  const auto progress = [&](PrecomputePhase phase, double fraction) {
    clock.enter(phase);
    bar.show(static_cast<std::uint64_t>(100 * fraction), 100, PhaseClock::name(phase));
  };
  const Result<PrecomputeReport> result = precompute(job, progress);
  bar.end_line();
  if (!result) return report("precompute", result.error());
  if (options.json) {
    print_json(to_json(options, *result, clock));
  } else if (!options.quiet) {
    print_text(options, *result, clock);
  }
  return kExitOk;
}

}  // namespace

void add_precompute(CLI::App& app, int& exit_status) {
  auto options = std::make_shared<Options>();
  PrecomputeOptions& job = options->precompute;
  job.threads = std::max(1u, std::thread::hardware_concurrency());
  CLI::App* verb = app.add_subcommand("precompute", "Turn a mesh into a progressive PM file");
  verb->add_option("IN", job.input, "Mesh file: .ply, .obj, .stl or .off")->required();
  verb->add_option("-o,--output", job.output, "PM file to write: .pmesh")->required();
  add_metric_options(*verb, *options);
  add_precision_options(*verb, job.precision);
  verb->add_option("--schedule", job.schedule,
                   "Order of the collapses: batched (smaller files) or exact (the metric's own)")
      ->transform(CLI::CheckedTransformer(kSchedules).description("batched|exact"))
      ->default_str("batched");
  verb->add_option("--base-faces", job.base_faces, "Faces of the base mesh, if topology allows")
      ->check(CLI::Range(1u, 10'000'000u))
      ->capture_default_str();
  verb->add_option("--threads", job.threads, "Threads; the output does not depend on it")
      ->check(CLI::Range(1u, 1024u))
      ->capture_default_str();
  verb->add_flag("--no-measure", options->no_measure,
                 "Leave the error of each level of detail unmeasured");
  verb->add_flag("--force", options->force, "Replace OUT if it exists");
  verb->add_flag("--json", options->json, "Print one JSON object");
  verb->add_flag("--quiet", options->quiet, "Print nothing but errors");
  verb->callback([options, &exit_status] { exit_status = run_precompute(*options); });
}

}  // namespace pmesh::cli
