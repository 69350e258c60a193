#include "cli/exit_codes.h"

#include <cstdio>

namespace pmesh::cli {

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::runtime:
      return kExitRuntime;
    case ErrorCode::usage:
      return kExitUsage;
    case ErrorCode::bad_input:
      return kExitBadInput;
    case ErrorCode::verification:
      return kExitVerification;
    case ErrorCode::out_of_resources:
      return kExitResources;
  }
  return kExitRuntime;
}

int report(std::string_view verb, const Error& error) {
  std::fprintf(stderr, "pmesh %.*s: %s\n", static_cast<int>(verb.size()), verb.data(),
               error.message.c_str());
  return exit_code(error.code);
}

}  // namespace pmesh::cli
