#include "server/http/head_syntax.h"

#include <algorithm>
#include <array>

namespace pmesh {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr bool is_token_character(char c) {
  const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return is_letter || is_digit(c) ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

/// Visible US-ASCII: what a target is made of.
constexpr bool is_visible(char c) { return c > ' ' && c < '\x7F'; }

/// What a field's value may hold: text, blanks, and bytes above US-ASCII.
constexpr bool is_value_character(char c) {
  return c == '\t' || (static_cast<unsigned char>(c) >= ' ' && c != '\x7F');
}

/// What the name of a host is made of: RFC 3986's unreserved characters, sub-delims and escapes.
constexpr bool is_name_character(char c) {
  return is_token_character(c) ? std::string_view("#^`|").find(c) == std::string_view::npos
                               : std::string_view("(),;=").find(c) != std::string_view::npos;
}

/// What stands in the brackets of an address.
constexpr bool is_literal_character(char c) {
  return c == ':' || (c != '%' && is_name_character(c));
}

/// The characters for which a predicate holds, as a table.
class Characters {
 public:
  constexpr explicit Characters(bool (*contains)(char)) {
    for (int c = 0; c < 256; ++c) contains_[c] = contains(static_cast<char>(c));
  }

  bool hold(std::string_view text) const {
    return std::all_of(text.begin(), text.end(),
                       [this](char c) { return contains_[static_cast<unsigned char>(c)]; });
  }

 private:
  std::array<bool, 256> contains_{};
};

constexpr Characters kDigits(is_digit);
constexpr Characters kTokenCharacters(is_token_character);
constexpr Characters kVisible(is_visible);
constexpr Characters kValueCharacters(is_value_character);
constexpr Characters kNameCharacters(is_name_character);
constexpr Characters kLiteralCharacters(is_literal_character);

bool is_token(std::string_view text) { return !text.empty() && kTokenCharacters.hold(text); }

int check_request_line(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return 400;
  const std::string_view target = line.substr(first + 1, last - first - 1);
  if (!is_token(line.substr(0, first)) || !kVisible.hold(target)) return 400;
  const std::string_view version = line.substr(last + 1);
  return version == "HTTP/1.1" || version == "HTTP/1.0" ? 0 : 400;
}

bool is_field_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  return colon != std::string_view::npos && is_token(line.substr(0, colon)) &&
         kValueCharacters.hold(line.substr(colon + 1));
}

/// Takes a line off the front of `head`, which holds one.
std::string_view take_line(std::string_view& head) {
  const std::string_view line = head.substr(0, head.find(kLineEnd));
  head.remove_prefix(line.size() + kLineEnd.size());
  return line;
}

/// Whether `text` is what may follow a host: nothing, or a colon and a port, which may be empty.
bool is_port(std::string_view text) {
  return text.empty() || (text.front() == ':' && kDigits.hold(text.substr(1)));
}

}  // namespace

int check_head(std::string_view head) {
  if (const int refusal = check_request_line(take_line(head)); refusal != 0) return refusal;
  while (true) {
    const std::string_view line = take_line(head);
    if (line.empty()) return 0;
    if (!is_field_line(line)) return 400;
  }
}

bool is_host(std::string_view value) {
  if (!value.starts_with('[')) {
    const std::string_view name = value.substr(0, value.find(':'));
    return kNameCharacters.hold(name) && is_port(value.substr(name.size()));
  }
  const std::size_t end = value.find(']');
  if (end == std::string_view::npos) return false;
  const std::string_view address = value.substr(1, end - 1);
  return !address.empty() && kLiteralCharacters.hold(address) && is_port(value.substr(end + 1));
}

}  // namespace pmesh
