// The configuration of `pmesh serve`, gathered: a flag goes before the environment, that before the
// config file, that before the default.
//
// Threads: pure functions, but for reading files and the environment.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "server/config/config_file.h"
#include "server/config/serve_config.h"

namespace pmesh {

struct ConfigSources {
  std::string file;                          ///< The config file; empty: none.
  std::map<std::string, std::string> flags;  ///< The value of each flag given, by setting's name.
  /// The value of an environment variable; null if it is not set. One that is empty counts as not
  /// set.
  std::function<const char*(const char*)> environment;
};

/// Gathers and checks; reads config, token and key file. Fails (usage) with where a value came from
/// and what is wrong with it: "pmesh.json: threads: expected a whole number from 0 to 1024, found
/// -1", "PMESH_THREADS: ...", "--threads: ...". A key of the file that is no setting is one error.
Result<ServeConfig> load_config(const ConfigSources& sources);

/// Sets what the members say; they come from `origin`, which errors begin with.
Status apply_members(const std::vector<NamedValue>& members, const std::string& origin,
                     ServeConfig& config);

/// Every setting as a config file that gives the same configuration. Holds no secrets, only the
/// paths of their files.
std::string print_config(const ServeConfig& config);

}  // namespace pmesh
