// The header fields of an HTTP answer.
#pragma once

#include <string>
#include <string_view>

namespace pmesh {

/// Fields in the order in which they were added, kept as the lines that go to the wire.
class HeaderFields {
 public:
  /// Precondition: neither holds a line end.
  void add(std::string_view name, std::string_view value) {
    if (lines_.empty()) lines_.reserve(kUsualBytes);
    lines_.append(name).append(": ").append(value).append("\r\n");
  }

  /// The value of the first field of that name (as it was added, letter by letter); empty if none.
  std::string_view find(std::string_view name) const {
    std::string_view rest = lines_;
    while (!rest.empty()) {
      const std::string_view line = rest.substr(0, rest.find("\r\n"));
      rest.remove_prefix(line.size() + 2);
      if (line.starts_with(name) && line.substr(name.size()).starts_with(": ")) {
        return line.substr(name.size() + 2);
      }
    }
    return {};
  }

  const std::string& lines() const { return lines_; }

 private:
  static constexpr std::size_t kUsualBytes = 512;

  std::string lines_;
};

}  // namespace pmesh
