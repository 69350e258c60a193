#include "server/metrics/prometheus.h"

#include <atomic>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include <sys/resource.h>
#include <unistd.h>

#include "server/store/look.h"

namespace pmesh {
namespace {

/// Writes samples, each family after its HELP and TYPE.
class Writer {
 public:
  void family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    text_.append("# HELP ").append(name).append(" ").append(help).append("\n");
    text_.append("# TYPE ").append(name).append(" ").append(type).append("\n");
  }
  void sample(double value, std::string_view labels = {}, std::string_view suffix = {}) {
    text_.append(name_).append(suffix);
    if (!labels.empty()) text_.append("{").append(labels).append("}");
    char number[32];
    const auto [end, error] = std::to_chars(number, number + sizeof number, value);
    text_.append(" ").append(number, end).append("\n");
  }
  void counter(std::string_view name, std::string_view help, double value) {
    family(name, "counter", help);
    sample(value);
  }
  void gauge(std::string_view name, std::string_view help, double value) {
    family(name, "gauge", help);
    sample(value);
  }

  std::string take() { return std::move(text_); }

 private:
  std::string name_;
  std::string text_;
};

std::string label(std::string_view name, std::string_view value) {
  return std::string(name).append("=\"").append(value).append("\"");
}

template <class Label, std::size_t N>
void write_counters(Writer& out, const Counters<Label>& counters, std::string_view label_name,
                    const std::array<std::string_view, N>& names) {
  static_assert(Counters<Label>::kCount == N);
  for (std::size_t i = 0; i < N; ++i) {
    out.sample(static_cast<double>(counters.get(static_cast<Label>(i))),
               label(label_name, names[i]));
  }
}

void write_connections(Writer& out, const Metrics& metrics) {
  out.family("pmesh_connections", "gauge", "Open connections.");
  write_counters(out, metrics.open, "protocol", kWireProtocolNames);
  out.family("pmesh_connections_accepted_total", "counter",
             "Connections taken, also to be turned away.");
  write_counters(out, metrics.accepted, "protocol", kWireProtocolNames);
  out.family("pmesh_sent_bytes_total", "counter", "Bytes handed to the kernel, before TLS.");
  write_counters(out, metrics.sent_bytes, "protocol", kWireProtocolNames);
  out.family("pmesh_limits_total", "counter",
             "Connections and requests that met a limit, by the limit.");
  write_counters(out, metrics.limits, "limit", kLimitNames);
}

void write_requests(Writer& out, const Metrics& metrics) {
  out.family("pmesh_requests_total", "counter", "HTTP answers, by route and status.");
  for (std::size_t route = 0; route < kRouteNames.size(); ++route) {
    for (std::size_t status = 0; status < RequestCounts::kStatuses.size(); ++status) {
      const auto count = metrics.requests.get(static_cast<RouteName>(route), status);
      if (count == 0) continue;
      out.sample(static_cast<double>(count),
                 label("route", kRouteNames[route]) + "," +
                     label("status", std::to_string(RequestCounts::kStatuses[status])));
    }
  }
  const DurationHistogram& durations = metrics.durations;
  constexpr std::size_t kAll = DurationHistogram::kBounds.size();
  out.family("pmesh_request_seconds", "histogram",
             "From a request's end to its answer's last byte handed to the kernel.");
  for (std::size_t i = 0; i < kAll; ++i) {
    char bound[32];
    std::snprintf(bound, sizeof bound, "le=\"%g\"", DurationHistogram::kBounds[i]);
    out.sample(static_cast<double>(durations.count_up_to(i)), bound, "_bucket");
  }
  const auto all = static_cast<double>(durations.count_up_to(kAll));
  out.sample(all, "le=\"+Inf\"", "_bucket");
  out.sample(durations.seconds(), {}, "_sum");
  out.sample(all, {}, "_count");
}

void write_lod(Writer& out, const LodStatistics& lod) {
  out.counter("pmesh_lod_made_total", "Finished levels of detail made.",
              static_cast<double>(lod.made));
  out.counter("pmesh_lod_cache_hits_total", "Levels of detail answered from memory.",
              static_cast<double>(lod.hits));
  out.counter("pmesh_lod_merged_total", "Requests that waited for one under way.",
              static_cast<double>(lod.merged));
  out.counter("pmesh_lod_refused_total", "Requests refused for want of a place in the queue.",
              static_cast<double>(lod.refused));
  out.counter("pmesh_lod_seconds_total", "Time spent making them.", lod.seconds);
  out.gauge("pmesh_lod_queued", "Levels of detail waiting to be made.",
            static_cast<double>(lod.queued));
  out.gauge("pmesh_lod_cached_bytes", "Bytes of levels of detail kept in memory.",
            static_cast<double>(lod.cached_bytes));
}

/// Pages in memory, the second number of /proc/self/statm; 0 if it cannot be read.
double resident_pages() {
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (file == nullptr) return 0;
  unsigned long all = 0, resident = 0;
  const bool is_read = std::fscanf(file, "%lu %lu", &all, &resident) == 2;
  std::fclose(file);
  return is_read ? static_cast<double>(resident) : 0;
}

/// Counted at most once a second: there may be many thousands.
double open_descriptors() {
  static const Look look;
  static std::atomic<double> count = 0;
  if (!look.is_due(std::chrono::seconds(1))) return count;
  std::error_code error;
  double open = 0;
  std::filesystem::directory_iterator entry("/proc/self/fd", error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) ++open;
  return count = open;
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

/// By the names that Prometheus's own libraries use.
void write_process(Writer& out, const Metrics& metrics) {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) == 0) {
    out.counter("process_cpu_seconds_total", "User and system time.",
                seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime));
  }
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0) {
    out.gauge("process_max_fds", "Descriptors that may be open.",
              static_cast<double>(limit.rlim_cur));
  }
  out.gauge("process_open_fds", "Open descriptors.", open_descriptors());
  out.gauge("process_resident_memory_bytes", "Memory in use.",
            resident_pages() * static_cast<double>(::sysconf(_SC_PAGESIZE)));
  const auto started = metrics.started.time_since_epoch();
  out.gauge("process_start_time_seconds", "When the server started, in Unix time.",
            std::chrono::duration<double>(started).count());
}

}  // namespace

std::string prometheus_text(const Metrics& metrics, const LodStatistics& lod, std::size_t meshes) {
  Writer out;
  write_connections(out, metrics);
  write_requests(out, metrics);
  write_lod(out, lod);
  out.gauge("pmesh_meshes", "Meshes in the catalogue.", static_cast<double>(meshes));
  out.family("pmesh_reloads_total", "counter", "Reloads of the configuration.");
  write_counters(out, metrics.reloads, "result", kReloadResultNames);
  out.counter("pmesh_broken_files_total", "Transfers cut because the file was written to.",
              static_cast<double>(metrics.broken_files.load()));
  write_process(out, metrics);
  return out.take();
}

}  // namespace pmesh
