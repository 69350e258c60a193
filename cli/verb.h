// The verbs of `pmesh`, a file each. A verb adds its subcommand and options to `app`; if the user
// chose it, its callback runs and stores the process's exit status.
#pragma once

#include <CLI/App.hpp>

namespace pmesh::cli {

void add_precompute(CLI::App& app, int& exit_status);
void add_info(CLI::App& app, int& exit_status);
void add_verify(CLI::App& app, int& exit_status);
void add_extract(CLI::App& app, int& exit_status);
void add_compare(CLI::App& app, int& exit_status);
void add_serve(CLI::App& app, int& exit_status);
void add_fetch(CLI::App& app, int& exit_status);
void add_export(CLI::App& app, int& exit_status);
void add_sign(CLI::App& app, int& exit_status);
void add_health(CLI::App& app, int& exit_status);

}  // namespace pmesh::cli
