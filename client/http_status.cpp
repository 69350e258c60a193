#include "client/http_status.h"

#include <algorithm>
#include <charconv>

namespace pmesh {
namespace {

std::optional<std::uint64_t> take_number(std::string_view& text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

}  // namespace

// "bytes 0-99/1234", "bytes 0-99/*" or, in a 416, "bytes */1234" (RFC 9110, section 14.4).
void parse_content_range(std::string_view text, HttpResponse& response) {
  if (!take(text, "bytes ")) return;
  if (!take(text, "*")) {
    const std::optional<std::uint64_t> first = take_number(text);
    if (!first || !take(text, "-")) return;
    const std::optional<std::uint64_t> last = take_number(text);
    if (!last || *last < *first || *last == UINT64_MAX) return;
    response.content_range = ByteSpan{*first, *last + 1};
  }
  if (take(text, "/")) response.total_bytes = take_number(text);
}

std::optional<std::chrono::milliseconds> parse_retry_after(std::string_view text) {
  constexpr std::uint64_t kDay = 24 * 60 * 60;
  const std::optional<std::uint64_t> seconds = take_number(text);
  if (!seconds || !text.empty()) return std::nullopt;
  return std::chrono::seconds(std::min(*seconds, kDay));
}

TransportStatus check_status(const HttpResponse& response, const std::string& url) {
  const unsigned status = response.status;
  if (status == 200 || status == 206) return std::nullopt;
  const std::string answer = url + ": HTTP status " + std::to_string(status);
  if (status == 401 || status == 403) {
    return final_error(runtime_error(answer + " (a valid token or signed URL is needed)"));
  }
  if (status == 404 || status == 410) return final_error(runtime_error(answer + " (not found)"));
  if (status >= 300 && status < 400 && !response.location.empty()) {
    return final_error(runtime_error(answer + ": moved to " + response.location));
  }
  const bool retryable = status >= 500 || status == 408 || status == 429;
  return TransportError{runtime_error(answer), retryable, response.retry_after};
}

}  // namespace pmesh
