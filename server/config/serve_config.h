// All that `pmesh serve` can be set to.
#pragma once

#include <string>

#include "server/log/structured_log.h"
#include "server/options.h"

namespace pmesh {

struct ServeConfig {
  ServerOptions server;      ///< With the secrets that were read from the two files below.
  std::string token_file;    ///< Empty: no tokens. See server/access/credentials.h for both.
  std::string url_key_file;  ///< Empty: no signed URLs.
  LogFormat log_format = LogFormat::text;
  std::string log_level = "info";  ///< As log_level() knows it.
};

}  // namespace pmesh
