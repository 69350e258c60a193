// What the programs of bench/bytes share.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "core/base/result.h"

namespace pmesh::bench {

/// Ends the program with `message` on standard error.
[[noreturn]] inline void fail(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

/// The value; ends the program if there is none.
template <class T>
T wanted(Result<T> result) {
  if (!result) fail(result.error().message);
  return std::move(*result);
}

}  // namespace pmesh::bench
