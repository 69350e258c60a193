// pmesh serve: a directory of PM files over HTTP and TCP, until SIGTERM or SIGINT.
#include <memory>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include "cli/exit_codes.h"
#include "cli/verb.h"
#include "server/server.h"

namespace pmesh::cli {
namespace {

/// Every connection and every mesh takes a descriptor, and the usual limit is only 1024.
void allow_all_descriptors() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

int run_serve(ServerOptions options) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("pmesh"));
  allow_all_descriptors();
  if (options.http == "none") options.http.clear();
  if (options.http.empty() && options.tcp.empty()) {
    return report("serve",
                  {ErrorCode::usage, "there is nothing to serve on: neither HTTP nor TCP"});
  }
  Result<std::unique_ptr<Server>> opened = Server::open(options);
  if (!opened) return report("serve", opened.error());
  Server& server = **opened;
  server.handle_signals();
  if (!server.http_address().empty()) spdlog::info("HTTP on http://{}/", server.http_address());
  if (!server.tcp_address().empty()) spdlog::info("TCP on tcp://{}/", server.tcp_address());
  server.run();
  spdlog::info("stopped");
  return kExitOk;
}

}  // namespace

void add_serve(CLI::App& app, int& exit_status) {
  auto options = std::make_shared<ServerOptions>();
  CLI::App* verb = app.add_subcommand("serve", "Serve a directory of PM files");
  verb->add_option("DIR", options->directory, "Directory of PM files, searched to any depth")
      ->required();
  verb->add_option("--http", options->http,
                   "ADDR:PORT to serve HTTP on, or none; port 0 is any free one")
      ->capture_default_str();
  verb->add_option("--tcp", options->tcp,
                   "ADDR:PORT to serve the TCP protocol on; not served unless given");
  verb->callback([options, &exit_status] { exit_status = run_serve(*options); });
}

}  // namespace pmesh::cli
