// pmesh fetch: any level of detail of a mesh, from a server, a plain web host or a file.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/check_distinct.h"
#include "cli/exit_codes.h"
#include "cli/json.h"
#include "cli/progress_bar.h"
#include "cli/verb.h"
#include "cli/wish_options.h"
#include "client/fetch_to_file.h"
#include "core/files/read_file.h"

namespace pmesh::cli {
namespace {

struct FetchArguments {
  std::string url;
  std::string output;
  WishOptions wish;
  std::string token;
  std::string token_file;
  std::vector<std::string> headers;
  std::string ca_file;
  bool json = false;
  bool force = false;
  bool quiet = false;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

CancelFlag interrupted{false};

// The first CTRL-C ends the fetch with what it has; a second one kills the process.
void cancel_on_interrupt() {
  static_assert(CancelFlag::is_always_lock_free);
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted.store(true); };
  action.sa_flags = SA_RESETHAND;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

// What the user sees of a running fetch.
class FetchDisplay {
 public:
  explicit FetchDisplay(const FetchArguments& arguments)
      : url_(arguments.url), quiet_(arguments.quiet), bar_(!arguments.quiet) {}

  StreamOptions stream_options() {
    StreamOptions options;
    options.name = url_;
    options.cancel = &interrupted;
    options.on_progress = [this](const StreamProgress& progress) { show(progress); };
    options.on_retry = [this](const Error& error) {
      if (quiet_) return;
      bar_.end_line();
      std::fprintf(stderr, "pmesh fetch: %s; trying again\n", error.message.c_str());
    };
    return options;
  }

  void end_line() { bar_.end_line(); }

  double seconds() const { return seconds_since(start_); }
  std::optional<double> first_picture_seconds() const { return first_picture_; }

 private:
  void show(const StreamProgress& progress) {
    if (progress.faces > 0 && !first_picture_) first_picture_ = seconds();
    bar_.show(progress.bytes_held, progress.bytes_wanted,
              std::to_string(progress.bytes_held) + " bytes, " + std::to_string(progress.faces) +
                  " faces");
  }

  std::string url_;
  bool quiet_;
  ProgressBar bar_;
  Clock::time_point start_ = Clock::now();
  std::optional<double> first_picture_;
};

Json to_json(const FetchArguments& arguments, const FetchReport& report,
             const FetchDisplay& display) {
  const auto first_picture = display.first_picture_seconds();
  return {{"url", arguments.url},
          {"hash", to_hex(report.hash)},
          {"faces", report.faces},
          {"vertices", report.vertices},
          {"bytes_fetched", report.bytes_fetched},
          {"bytes_total", report.bytes_total},
          {"reached", report.reached},
          {"complete", report.complete},
          {"seconds", display.seconds()},
          {"first_picture_seconds", first_picture ? Json(*first_picture) : Json(nullptr)},
          {"output", arguments.output}};
}

void print_note(const FetchArguments& arguments, const FetchReport& report) {
  if (!report.reached) {
    std::fprintf(stderr, "pmesh fetch: %s: the wish is out of reach; %llu faces is the nearest\n",
                 arguments.url.c_str(), static_cast<unsigned long long>(report.faces));
  }
  if (arguments.json || arguments.quiet) return;
  std::printf("%s: %llu faces, %llu vertices, %llu of %llu bytes fetched\n",
              arguments.output.c_str(), static_cast<unsigned long long>(report.faces),
              static_cast<unsigned long long>(report.vertices),
              static_cast<unsigned long long>(report.bytes_fetched),
              static_cast<unsigned long long>(report.bytes_total));
}

// What shows the server who asks, and the client whom it asks.
Result<TransportOptions> transport_options(const FetchArguments& arguments) {
  TransportOptions options;
  options.cancel = &interrupted;
  options.ca_file = arguments.ca_file;
  std::string token = arguments.token;
  if (!arguments.token_file.empty()) {
    const Result<Bytes> file = read_file(arguments.token_file);
    if (!file) return file.error();
    token.assign(file->begin(), file->end());
  }
  if (!token.empty() || !arguments.token_file.empty()) {
    const Result<std::string> parsed = parse_token(token);
    if (!parsed) return parsed.error();
    options.token = *parsed;
  }
  for (const std::string& header : arguments.headers) {
    const Result<HttpField> field = parse_http_field(header);
    if (!field) return field.error();
    options.http_fields.push_back(*field);
  }
  return options;
}

Result<FetchReport> fetch(const FetchArguments& arguments, FetchDisplay& display) {
  const Result<MeshUrl> url = parse_mesh_url(arguments.url);
  if (!url) return url.error();
  if (const auto* local = std::get_if<LocalFile>(&*url)) {
    if (Status distinct = check_distinct(local->path, arguments.output); !distinct) {
      return distinct.error();
    }
  }
  const Result<TransportOptions> options = transport_options(arguments);
  if (!options) return options.error();
  const std::unique_ptr<Transport> transport = make_transport(*url, *options);
  const FetchJob job{arguments.wish.wish(), arguments.output, arguments.force};
  return fetch_to_file(*transport, job, display.stream_options());
}

int run(const FetchArguments& arguments) {
  cancel_on_interrupt();
  FetchDisplay display(arguments);
  const Result<FetchReport> report = fetch(arguments, display);
  display.end_line();
  if (!report) return cli::report("fetch", report.error());
  if (arguments.json) print_json(to_json(arguments, *report, display));
  print_note(arguments, *report);
  return kExitOk;
}

}  // namespace

void add_fetch(CLI::App& app, int& exit_status) {
  CLI::App* verb = app.add_subcommand("fetch", "Fetch any level of detail of a mesh");
  const auto arguments = std::make_shared<FetchArguments>();
  verb->add_option("url", arguments->url,
                   "http[s]://HOST:PORT/ID, ws[s]://HOST:PORT/ID, http[s]://HOST/FILE.pmesh, "
                   "tcp[s]://HOST:PORT/ID or a path")
      ->required();
  verb->add_option(
          "-o,--output", arguments->output,
          "What to write: .ply, .obj, .glb, .drc, or .pmesh, which a later fetch continues")
      ->required();
  arguments->wish.add_to(*verb);
  auto* const token = verb->add_option("--token", arguments->token,
                                       "Bearer token to show the server (others on this machine "
                                       "may see it in the list of processes)");
  verb->add_option("--token-file", arguments->token_file, "File that holds the token")
      ->excludes(token);
  verb->add_option("--header", arguments->headers, "'Name: value' to send with every HTTP request")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->add_option("--ca", arguments->ca_file,
                   "PEM file of the certificate authorities to trust instead of the system's");
  verb->add_flag("--json", arguments->json, "Print one JSON object on stdout");
  verb->add_flag("--force", arguments->force, "Start a .pmesh over, whatever file is there");
  verb->add_flag("--quiet", arguments->quiet, "No progress bar and no summary");
  verb->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

}  // namespace pmesh::cli
