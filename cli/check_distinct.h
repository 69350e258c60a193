// Keeps a verb from replacing the file that it reads.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/result.h"

namespace pmesh::cli {

/// Fails (usage) if both paths lead to the same file.
inline Status check_distinct(const std::string& input, const std::string& output) {
  std::error_code ignored;  // no such file: then they are distinct
  if (!std::filesystem::equivalent(input, output, ignored)) return {};
  return Error{ErrorCode::usage, output + ": is the input, which would be replaced"};
}

}  // namespace pmesh::cli
