// What the user adds to the requests of a fetch: a token, and header fields.
//
// Threads: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace pmesh {

struct HttpField {
  std::string name;
  std::string value;
  friend bool operator==(const HttpField&, const HttpField&) = default;
};

/// "Name: value". Fails (usage) on what cannot be a field (RFC 9110, section 5), and on a field
/// that the client must set itself: Host, Range, those of a body, a connection, or an upgrade.
Result<HttpField> parse_http_field(std::string_view text);

/// A bearer token (RFC 6750) without the white space around it, such as the end of a file's line.
/// Fails (usage) on what can be none.
Result<std::string> parse_token(std::string_view text);

/// `fields`, led by the one that shows the token unless that is empty.
std::vector<HttpField> with_token(const std::string& token, std::vector<HttpField> fields);

}  // namespace pmesh
