// pmesh health: whether a server answers, for those who supervise it (containers, systemd).
#include <chrono>
#include <memory>
#include <string>
#include <variant>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/verb.h"
#include "client/http_client.h"
#include "client/http_status.h"

namespace pmesh::cli {
namespace {

/// A server's URL is what a mesh's URL has before the id.
Result<HttpMesh> parse_server_url(const std::string& url) {
  const Result<MeshUrl> parsed = parse_mesh_url(url + "/mesh");
  const auto* mesh = parsed ? std::get_if<HttpMesh>(&*parsed) : nullptr;
  if (mesh == nullptr) return Error{ErrorCode::usage, url + ": expected http://HOST:PORT"};
  return *mesh;
}

Status ask(const std::string& url) {
  const Result<HttpMesh> server = parse_server_url(url);
  if (!server) return server.error();
  const std::string target = server->prefix + "/health";
  TransportOptions options;
  options.connect_timeout = options.idle_timeout = std::chrono::seconds(5);
  HttpClient client(server->endpoint, options);
  const auto on_head = [&](const HttpResponse& response) {
    return check_status(response, client.url_of(target));
  };
  const auto failed = client.get(target, std::nullopt, on_head, [](ByteView) { return true; });
  return failed ? Status(failed->error) : Status();
}

int run(const std::string& url) {
  const Status status = ask(url);
  return status ? kExitOk : report("health", status.error());
}

}  // namespace

void add_health(CLI::App& app, int& exit_status) {
  const auto url = std::make_shared<std::string>("http://127.0.0.1:8080");
  CLI::App* verb = app.add_subcommand("health", "Ask a server whether it is up: exit 0, or 1");
  verb->add_option("URL", *url, "http://HOST:PORT")->capture_default_str();
  verb->callback([url, &exit_status] { exit_status = run(*url); });
}

}  // namespace pmesh::cli
