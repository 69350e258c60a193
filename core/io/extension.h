// File formats by the extension of a file's name.
#pragma once

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

namespace pmesh {

/// What `formats` has for the extension that `path` ends in: ".ply", say, in any case.
template <class Format, std::size_t N>
std::optional<Format> format_by_extension(std::string_view path,
                                          const std::pair<std::string_view, Format> (&formats)[N]) {
  for (const auto& [extension, format] : formats) {
    if (path.size() < extension.size()) continue;
    const auto same_letter = [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == b;
    };
    if (std::ranges::equal(path.substr(path.size() - extension.size()), extension, same_letter)) {
      return format;
    }
  }
  return std::nullopt;
}

}  // namespace pmesh
