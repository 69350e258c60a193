// pmesh serve: a directory of PM files over HTTP and TCP, until SIGTERM or SIGINT.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include "cli/exit_codes.h"
#include "cli/verb.h"
#include "server/config/live_config.h"
#include "server/policy.h"
#include "server/server.h"

namespace pmesh::cli {
namespace {

struct ServeArguments {
  ConfigSources sources;
  bool check = false;
  bool print = false;
};

/// Every connection and every mesh takes a descriptor, and the usual limit is only 1024.
void allow_all_descriptors() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

void set_up_log(const ServeConfig& config) {
  auto logger = spdlog::stderr_logger_mt("pmesh");
  logger->set_formatter(make_log_formatter(config.log_format));
  spdlog::set_default_logger(std::move(logger));
  spdlog::set_level(log_level(config.log_level));
}

int serve(const ConfigSources& sources, const ServeConfig& config) {
  set_up_log(config);
  allow_all_descriptors();
  Result<std::unique_ptr<Server>> opened = Server::open(config.server);
  if (!opened) return report("serve", opened.error());
  Server& server = **opened;
  LiveConfig live(sources, config);
  server.handle_signals([&live] { return live.reload(); });
  const char* secure = config.server.tls.key.empty() ? "" : "s";
  if (!server.http_address().empty()) {
    spdlog::info("HTTP on http{}://{}/", secure, server.http_address());
  }
  if (!server.tcp_address().empty()) {
    spdlog::info("TCP on tcp{}://{}/", secure, server.tcp_address());
  }
  if (!server.metrics_address().empty()) {
    spdlog::info("metrics on http{}://{}/metrics", secure, server.metrics_address());
  }
  server.run();
  spdlog::info("stopped");
  return kExitOk;
}

int run(const ServeArguments& arguments) {
  const Result<ServeConfig> config = load_config(arguments.sources);
  if (!config) return report("serve", config.error());
  if (const auto policy = make_policy(config->server); !policy) {
    return report("serve", policy.error());
  }
  if (arguments.print) std::puts(print_config(*config).c_str());
  if (arguments.check || arguments.print) return kExitOk;
  return serve(arguments.sources, *config);
}

std::string as_default_text(const SettingValue& value) {
  return value.is_string() ? value.get<std::string>() : value.empty() ? "" : value.dump();
}

/// A flag for every setting; the directory may also stand alone.
void add_settings(CLI::App& verb, ConfigSources& sources) {
  for (const Setting& setting : settings()) {
    const std::string name = setting.name;
    const std::string spelling = "--" + name + (name == "directory" ? ",DIR" : "");
    const auto note = [&sources, name](const std::string& text) { sources.flags[name] = text; };
    CLI::Option* option = verb.add_option_function<std::string>(spelling, note, setting.help);
    option->type_name(setting.value_name)->default_str(as_default_text(setting.get({})));
    if (setting.get({}).is_array()) option->join(',');
  }
}

}  // namespace

void add_serve(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<ServeArguments>();
  arguments->sources.environment = [](const char* name) -> const char* {
    return std::getenv(name);
  };
  CLI::App* verb = app.add_subcommand("serve", "Serve a directory of PM files");
  verb->footer(
      "Every setting may also stand in the config file, as \"max-connections\": 1000, or\n"
      "in the environment, as PMESH_MAX_CONNECTIONS. A flag goes before the environment,\n"
      "that before the file.");
  verb->add_option("--config", arguments->sources.file, "JSON file of settings")
      ->type_name("FILE")
      ->envname("PMESH_CONFIG");
  verb->add_flag("--check-config", arguments->check, "Only check all settings; exit 0 or 2");
  verb->add_flag("--print-config", arguments->print, "Only print all settings, as a config file");
  add_settings(*verb, arguments->sources);
  verb->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

}  // namespace pmesh::cli
