// Exit statuses of every verb, and the one way errors reach the user.
#pragma once

#include <string_view>

#include "core/base/result.h"

namespace pmesh::cli {

inline constexpr int kExitOk = 0;
inline constexpr int kExitRuntime = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitVerification = 4;
inline constexpr int kExitResources = 5;

int exit_code(ErrorCode code);

/// Prints "pmesh VERB: message" on stderr and gives the exit status for it.
int report(std::string_view verb, const Error& error);

}  // namespace pmesh::cli
