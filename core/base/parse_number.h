// Text that is a number and nothing else.
//
// Threads: pure functions.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace pmesh {

/// All of `text` as a decimal number; nothing if it is empty, has other characters (blanks and a
/// leading '+' among them) or is out of T's range.
template <class T>
std::optional<T> parse_whole(std::string_view text) {
  T value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return {};
  return value;
}

}  // namespace pmesh
