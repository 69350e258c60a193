// Comparison of ASCII text whose letters may be of either case.
//
// Threads: pure functions.
#pragma once

#include <algorithm>
#include <string_view>

namespace pmesh {

/// Whether `text` begins with `prefix`, whatever the case of its letters. Precondition: `prefix`
/// has no upper-case letters.
inline bool begins_in_any_case(std::string_view text, std::string_view prefix) {
  const auto same = [](char expected, char c) {
    return expected == (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c);
  };
  return text.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), text.begin(), same);
}

}  // namespace pmesh
