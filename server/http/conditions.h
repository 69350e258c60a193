// Conditional and range requests (RFC 9110, sections 13 and 14) applied to an answer that is the
// whole.
#pragma once

#include <string_view>

#include "server/http/http_answer.h"

namespace pmesh {

/// Turns `answer`, which has its fields, into a 304 if the client has it already; then true.
bool answered_unchanged(HttpAnswer& answer, const HttpRequest& request, std::string_view etag);

/// Cuts the answer's span to the range asked for, if one is asked for and may be: one range is
/// honoured, up to `most_ranges` are ignored, more are refused.
void apply_range(HttpAnswer& answer, const HttpRequest& request, std::string_view etag,
                 std::size_t most_ranges);

}  // namespace pmesh
