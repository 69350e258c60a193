// pmesh export: a directory of PM files as files for a plain web host or a bucket.
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/json.h"
#include "cli/verb.h"
#include "server/export/static_export.h"

namespace pmesh::cli {
namespace {

struct ExportArguments {
  std::string directory;
  std::string output;
  bool is_static = false;
  bool delete_stale = false;
  bool json = false;
};

Json to_json(const ExportArguments& arguments, const ExportReport& report) {
  Json meshes = Json::array(), skipped = Json::array();
  for (const ExportedMesh& mesh : report.meshes) {
    const FileHeader& header = mesh.index.header;
    meshes.push_back({{"id", mesh.id},
                      {"hash", to_hex(header.content_hash)},
                      {"file_bytes", header.file_bytes},
                      {"new", mesh.is_new}});
  }
  for (const auto& [path, why] : report.skipped) {
    skipped.push_back({{"path", path}, {"reason", why}});
  }
  return {{"output", arguments.output},
          {"meshes", std::move(meshes)},
          {"skipped", std::move(skipped)},
          {"files_written", report.files_written},
          {"bytes_written", report.bytes_written},
          {"stale", report.stale},
          {"stale_deleted", arguments.delete_stale}};
}

void print_notes(const ExportArguments& arguments, const ExportReport& report) {
  for (const auto& [path, why] : report.skipped) {
    std::fprintf(stderr, "pmesh export: skipped %s: %s\n", path.c_str(), why.c_str());
  }
  if (arguments.json) return;
  std::printf("%s: %zu meshes, %llu files and %llu bytes written, %zu stale %s\n",
              arguments.output.c_str(), report.meshes.size(),
              static_cast<unsigned long long>(report.files_written),
              static_cast<unsigned long long>(report.bytes_written), report.stale.size(),
              arguments.delete_stale ? "deleted" : "left");
}

int run(const ExportArguments& arguments) {
  const Result<ExportReport> exported =
      export_static(arguments.directory, arguments.output, arguments.delete_stale);
  if (!exported) return report("export", exported.error());
  if (arguments.json) print_json(to_json(arguments, *exported));
  print_notes(arguments, *exported);
  return kExitOk;
}

}  // namespace

void add_export(CLI::App& app, int& exit_status) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* verb = app.add_subcommand("export", "Write a directory of PM files for a plain host");
  verb->add_option("DIR", arguments->directory, "Directory of PM files, searched to any depth")
      ->required();
  verb->add_option("OUT", arguments->output, "Directory to write; made if it is not there")
      ->required();
  verb->add_flag("--static", arguments->is_static,
                 "Hashed files, chunk files and catalogue under the server's URLs")
      ->required();
  verb->add_flag("--delete-stale", arguments->delete_stale,
                 "Delete what earlier exports wrote and no mesh needs any more");
  verb->add_flag("--json", arguments->json, "Print one JSON object on stdout");
  verb->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

}  // namespace pmesh::cli
