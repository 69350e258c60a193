// Exit statuses of every verb, and the one way errors reach the user.
//
// A bad file gives every verb that reads it the same status: kExitBadInput if it is no PM file;
// kExitVerification if it is one, but damaged (checksums, digests, counts, impossible splits) or
// cut short of its base. Only `verify` also minds a file that holds its base but not all chunks.
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
