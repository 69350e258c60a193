#include "client/http_field.h"

#include <algorithm>
#include <array>

#include "core/base/trimmed.h"
#include "protocol/letters.h"
#include "protocol/lod_request.h"

namespace pmesh {
namespace {

// Of lower case; one that ends in '-' stands for all that begin with it.
constexpr std::array<std::string_view, 9> kOwnFields = {
    "host",           "range",   "if-range",          "accept-encoding", "connection",
    "content-length", "upgrade", "transfer-encoding", "sec-websocket-"};

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool is_name_character(char c) {
  constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
  return is_letter_or_digit(c) || kOthers.find(c) != std::string_view::npos;
}

bool is_value_character(char c) {
  return c == '\t' || (static_cast<unsigned char>(c) >= ' ' && c != 0x7F);
}

bool is_token_character(char c) {
  constexpr std::string_view kOthers = "-._~+/=";
  return is_letter_or_digit(c) || kOthers.find(c) != std::string_view::npos;
}

bool is_own_field(std::string_view name) {
  return std::ranges::any_of(kOwnFields, [&](std::string_view own) {
    return begins_in_any_case(name, own) && (own.ends_with('-') || own.size() == name.size());
  });
}

}  // namespace

Result<HttpField> parse_http_field(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  if (colon == std::string_view::npos || name.empty() ||
      !std::ranges::all_of(name, is_name_character)) {
    return usage_error("header \"" + std::string(text) + "\": expected 'Name: value'");
  }
  if (is_own_field(name)) {
    return usage_error("header \"" + std::string(name) + "\": the client sets this one itself");
  }
  const std::string_view value = trimmed(text.substr(colon + 1));
  if (!std::ranges::all_of(value, is_value_character)) {
    return usage_error("header \"" + std::string(name) + "\": a control character in its value");
  }
  return HttpField{std::string(name), std::string(value)};
}

Result<std::string> parse_token(std::string_view text) {
  const std::string_view token = trimmed(text);
  if (token.empty() || !std::ranges::all_of(token, is_token_character)) {
    return usage_error("the token is empty, or has a character that no bearer token has");
  }
  return std::string(token);
}

std::vector<HttpField> with_token(const std::string& token, std::vector<HttpField> fields) {
  if (!token.empty()) fields.insert(fields.begin(), {"Authorization", "Bearer " + token});
  return fields;
}

}  // namespace pmesh
