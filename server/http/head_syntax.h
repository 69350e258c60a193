// The strict form of an HTTP request's head, beyond what Beast asks for.
//
// Threads: pure functions.
#pragma once

#include <string_view>

namespace pmesh {

/// 0 if `head`, up to and with its empty line, has the strict form of RFC 9112: lines that end in
/// CR LF, a request line of three parts and one space between them, field names that are tokens
/// right before their colon, no folded lines, no control characters. Else the status to refuse it
/// with.
int check_head(std::string_view head);

/// Whether `value` can be that of a Host field (RFC 9112, 3.2). An empty one can.
bool is_host(std::string_view value);

}  // namespace pmesh
