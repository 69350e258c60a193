// The configuration of a server that runs, and what reading it again changes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/config/load_config.h"

namespace pmesh {

/// Gives every setting of `reloaded` that needs a restart its value in `running` back; TLS may
/// change its files, but neither come nor go. Returns the names of the settings that differed.
std::vector<std::string> keep_until_restart(const ServeConfig& running, ServeConfig& reloaded);

/// Threads: one object belongs to one thread at a time.
class LiveConfig {
 public:
  /// `running` came from `sources`.
  LiveConfig(ConfigSources sources, ServeConfig running)
      : sources_(std::move(sources)), running_(std::move(running)) {}

  /// Loads the configuration again, sets the log level, and gives the options that the server is
  /// to have from now on. Logs a warning for each change that needs a restart. Fails as
  /// load_config() and make_policy() do, and then nothing has changed.
  Result<ServerOptions> reload();

 private:
  ConfigSources sources_;
  ServeConfig running_;
};

}  // namespace pmesh
