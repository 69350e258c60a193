// What the head of an HTTP response says to one who fetches a file.
//
// Threads: pure functions.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "client/transport.h"
#include "protocol/byte_range.h"

namespace pmesh {

struct HttpResponse {
  unsigned status = 0;
  std::optional<std::uint64_t> content_length;  ///< Of the body that follows.
  std::optional<ByteSpan> content_range;        ///< Of a 206.
  std::optional<std::uint64_t> total_bytes;     ///< The file's, from Content-Range (206 and 416).
  std::string location;
  std::optional<std::chrono::milliseconds> retry_after;
};

/// Fills in what a Content-Range field says (RFC 9110, section 14.4); nothing if it is none.
void parse_content_range(std::string_view text, HttpResponse& response);

/// The seconds of a Retry-After field, at most a day; nothing if it holds none. A date is not
/// understood.
std::optional<std::chrono::milliseconds> parse_retry_after(std::string_view text);

/// Nothing for 200 and 206; else why `url` cannot be had, and whether to ask again.
TransportStatus check_status(const HttpResponse& response, const std::string& url);

}  // namespace pmesh
