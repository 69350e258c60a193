#include "server/http/conditions.h"

#include <algorithm>

#include "core/base/trimmed.h"

namespace pmesh {
namespace {

/// The entity tag without a leading "W/": If-None-Match compares weakly.
std::string_view opaque_tag(std::string_view tag) {
  if (tag.starts_with("W/")) tag.remove_prefix(2);
  return tag;
}

/// Whether a comma-separated list of tags, or "*", holds `etag`. Our tags hold no commas.
bool lists_tag(std::string_view list, std::string_view etag) {
  if (trimmed(list) == "*") return true;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    if (opaque_tag(trimmed(list.substr(0, comma))) == etag) return true;
    list = comma == std::string_view::npos ? std::string_view() : list.substr(comma + 1);
  }
  return false;
}

void refuse_range(HttpAnswer& answer, std::uint64_t length, std::string_view why) {
  const RouteName route = answer.route;
  answer = error_answer(416, why);
  answer.route = route;
  answer.fields.add("Content-Range", "bytes */" + std::to_string(length));
}

}  // namespace

bool answered_unchanged(HttpAnswer& answer, const HttpRequest& request, std::string_view etag) {
  if (!lists_tag(request.if_none_match, etag)) return false;
  answer.status = 304;
  answer.text.clear();
  answer.mesh = nullptr;
  answer.shared = nullptr;
  return true;
}

void apply_range(HttpAnswer& answer, const HttpRequest& request, std::string_view etag,
                 std::size_t most_ranges) {
  const bool applies =
      request.method == "GET" && (request.if_range.empty() || trimmed(request.if_range) == etag);
  if (!applies) return;
  const std::uint64_t length = answer.span.size();
  const auto commas = std::count(request.range.begin(), request.range.end(), ',');
  if (static_cast<std::size_t>(commas) >= most_ranges) {
    refuse_range(answer, length, "too many ranges");
    answer.limit = LimitName::ranges;
    return;
  }
  const RangeChoice choice = choose_range(trimmed(request.range), length);
  if (choice.kind == RangeKind::whole) return;
  if (choice.kind == RangeKind::unsatisfiable) {
    return refuse_range(answer, length, "the range is beyond the end");
  }
  const auto [begin, end] = choice.span;
  answer.status = 206;
  answer.fields.add("Content-Range", "bytes " + std::to_string(begin) + "-" +
                                         std::to_string(end - 1) + "/" + std::to_string(length));
  answer.span = {answer.span.begin + begin, answer.span.begin + end};
}

}  // namespace pmesh
