// pmesh sign: a URL that lets whoever has it read one mesh for some time.
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/verb.h"
#include "protocol/mesh_id.h"
#include "server/access/credentials.h"
#include "server/access/signed_query.h"

namespace pmesh::cli {
namespace {

struct SignArguments {
  std::string id;
  std::string key_file;
  std::string server;
  std::uint64_t lifetime = 3600;
};

std::uint64_t unix_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::seconds>(now).count());
}

int run(SignArguments arguments) {
  if (!is_mesh_id(arguments.id)) {
    return report("sign", {ErrorCode::usage, arguments.id + ": is no mesh id"});
  }
  const Result<std::string> key = read_url_key_file(arguments.key_file);
  if (!key) return report("sign", key.error());
  const std::string query = sign_query(*key, arguments.id, unix_time() + arguments.lifetime);
  std::string& server = arguments.server;
  while (server.ends_with('/')) server.pop_back();
  if (!server.empty()) server.append("/").append(arguments.id).append("?");
  std::puts((server + query).c_str());
  return kExitOk;
}

}  // namespace

void add_sign(CLI::App& app, int& exit_status) {
  constexpr std::uint64_t kTenYears = 315'360'000;
  const auto arguments = std::make_shared<SignArguments>();
  CLI::App* verb = app.add_subcommand("sign", "Sign a URL: access to one mesh for some time");
  verb->add_option("ID", arguments->id, "The mesh's id")->required();
  verb->add_option("--key", arguments->key_file, "The server's url-key-file")
      ->type_name("FILE")
      ->required();
  verb->add_option("--lifetime", arguments->lifetime, "Seconds from now that it is good for")
      ->type_name("SECONDS")
      ->check(CLI::Range(std::uint64_t{1}, kTenYears))
      ->capture_default_str();
  verb->add_option("--server", arguments->server,
                   "URL to put before it, such as https://meshes.example.org; else only the query")
      ->type_name("URL");
  verb->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

}  // namespace pmesh::cli
