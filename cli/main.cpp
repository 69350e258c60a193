// pmesh: one binary, a verb each for the steps from a mesh file to a level of detail.
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include <CLI/CLI.hpp>

#include "cli/exit_codes.h"
#include "cli/verb.h"

namespace {

int run(int argc, char** argv) {
  CLI::App app{"pmesh: precompute, serve and fetch any level of detail of a triangle mesh",
               "pmesh"};
  app.set_version_flag("--version", PMESH_VERSION);
  app.require_subcommand(1);
  int exit_status = pmesh::cli::kExitOk;
  pmesh::cli::add_precompute(app, exit_status);
  pmesh::cli::add_info(app, exit_status);
  pmesh::cli::add_verify(app, exit_status);
  pmesh::cli::add_extract(app, exit_status);
  pmesh::cli::add_compare(app, exit_status);
  pmesh::cli::add_serve(app, exit_status);
  pmesh::cli::add_fetch(app, exit_status);
  pmesh::cli::add_export(app, exit_status);
  pmesh::cli::add_sign(app, exit_status);
  pmesh::cli::add_health(app, exit_status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? pmesh::cli::kExitOk : pmesh::cli::kExitUsage;
  }
  return exit_status;
}

// What was printed must have arrived, on a disk that is not full; a failure before that goes first.
int flush_output(int exit_status) {
  const bool is_lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (!is_lost) return exit_status;
  std::fputs("pmesh: standard output could not be written\n", stderr);
  return exit_status == pmesh::cli::kExitOk ? pmesh::cli::kExitRuntime : exit_status;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit on file sizes is to fail, not to kill
  try {
    return flush_output(run(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fputs("pmesh: out of memory\n", stderr);
    return pmesh::cli::kExitResources;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pmesh: %s\n", error.what());
    return pmesh::cli::kExitRuntime;
  }
}
