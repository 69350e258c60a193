#include "protocol/byte_range.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "protocol/letters.h"

namespace pmesh {
namespace {

constexpr std::string_view kUnit = "bytes=";

/// The value of one or more digits; a number too large for 64 bits is as good as their largest.
std::optional<std::uint64_t> parse_saturated(std::string_view digits) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  if (digits.empty()) return {};
  std::uint64_t value = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return {};
    const auto digit = static_cast<std::uint64_t>(c - '0');
    value = value > (kMax - digit) / 10 ? kMax : value * 10 + digit;
  }
  return value;
}

RangeChoice whole(std::uint64_t length) { return {RangeKind::whole, {0, length}}; }

RangeChoice last_bytes(std::uint64_t count, std::uint64_t length) {
  if (count == 0 || length == 0) return {RangeKind::unsatisfiable, {}};
  return {RangeKind::part, {length - std::min(count, length), length}};
}

}  // namespace

RangeChoice choose_range(std::string_view header, std::uint64_t length) {
  if (!begins_in_any_case(header, kUnit)) return whole(length);
  header.remove_prefix(kUnit.size());
  const std::size_t dash = header.find('-');
  if (dash == std::string_view::npos) return whole(length);

  const auto first = parse_saturated(header.substr(0, dash));
  const auto last = parse_saturated(header.substr(dash + 1));
  if (dash == 0) return last ? last_bytes(*last, length) : whole(length);
  const bool open_ended = dash + 1 == header.size();
  if (!first || !(last || open_ended)) return whole(length);
  if (last && *last < *first) return whole(length);
  if (*first >= length) return {RangeKind::unsatisfiable, {}};
  const std::uint64_t end = last && *last < length ? *last + 1 : length;
  return {RangeKind::part, {*first, end}};
}

}  // namespace pmesh
