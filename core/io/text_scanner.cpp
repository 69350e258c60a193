#include "core/io/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

namespace pmesh {
namespace {

constexpr std::size_t kLongestQuote = 24;

// CR counts as a blank: so CRLF needs no care.
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view without_plus(std::string_view field) {
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  return field;
}

std::string_view without_leading_blanks(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size() && is_blank(text[i])) ++i;
  return text.substr(i);
}

std::string_view first_field(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size() && !is_blank(text[i])) ++i;
  return text.substr(0, i);
}

// Whether the line ends with a backslash, which is then cut off together with blanks after it.
bool drop_backslash(std::string_view& line) {
  std::size_t size = line.size();
  while (size > 0 && is_blank(line[size - 1])) --size;
  if (size == 0 || line[size - 1] != '\\') return false;
  line = line.substr(0, size - 1);
  return true;
}

char line_end_of(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  const bool lone_cr = end != std::string_view::npos && text[end] == '\r' &&
                       (end + 1 == text.size() || text[end + 1] != '\n');
  return lone_cr ? '\r' : '\n';
}

// from_chars reports too large and too small alike and gives no value: a wider type tells which.
double beyond_double(std::string_view digits) {
  long double wide = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), wide);
  const bool unknown = parsed.ec != std::errc{};
  return unknown ? std::numeric_limits<double>::infinity() : static_cast<double>(wide);
}

}  // namespace

std::optional<double> parse_number(std::string_view field) {
  const std::string_view digits = without_plus(field);
  const char* const end = digits.data() + digits.size();
  double value = 0;
  const auto parsed = std::from_chars(digits.data(), end, value);
  if (parsed.ptr != end || parsed.ec == std::errc::invalid_argument) return std::nullopt;
  return parsed.ec == std::errc::result_out_of_range ? beyond_double(digits) : value;
}

std::optional<std::int64_t> parse_integer(std::string_view field) {
  const std::string_view digits = without_plus(field);
  const char* const end = digits.data() + digits.size();
  std::int64_t value = 0;
  const auto parsed = std::from_chars(digits.data(), end, value);
  if (parsed.ptr != end || parsed.ec != std::errc{}) return std::nullopt;
  return value;
}

bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, kLongestQuote)) out += (c >= ' ' && c <= '~') ? c : '?';
  return text.size() > kLongestQuote ? out + "..." : out;
}

std::string in_quotes(std::string_view text) {
  return std::string("'").append(printable(text)) + "'";
}

Error line_error(std::size_t line, const std::string& message) {
  return bad_input("line " + std::to_string(line) + ": " + message);
}

TextScanner::TextScanner(ByteView text)
    : text_(reinterpret_cast<const char*>(text.data()), text.size()) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  line_end_ = line_end_of(text_);
}

bool TextScanner::next_line() {
  if (text_.empty()) return false;
  const std::size_t end = text_.find(line_end_);
  rest_ = text_.substr(0, end);
  text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
  line_ += 1 + lines_joined_;
  lines_joined_ = 0;
  return true;
}

bool TextScanner::next_filled_line() {
  while (next_line()) {
    const std::string_view first = peek();
    if (!first.empty() && first[0] != '#') return true;
  }
  return false;
}

void TextScanner::join_continued_lines() {
  if (!drop_backslash(rest_)) return;
  std::string joined;
  const std::size_t first_line = line_;
  bool continues = true;
  while (continues) {
    joined.append(rest_).append(" ");
    if (!next_line()) break;
    continues = drop_backslash(rest_);
    if (!continues) joined.append(rest_);
  }
  lines_joined_ = line_ - first_line;
  line_ = first_line;
  joined_ = std::move(joined);
  rest_ = joined_;
}

std::string_view TextScanner::peek() const { return first_field(without_leading_blanks(rest_)); }

std::string_view TextScanner::field() {
  const std::string_view text = without_leading_blanks(rest_);
  const std::string_view found = first_field(text);
  rest_ = text.substr(found.size());
  return found;
}

Status TextScanner::read_numbers(std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::string_view found = field();
    if (found.empty()) {
      return error("expected " + std::to_string(out.size()) + " numbers, found " +
                   std::to_string(i));
    }
    const std::optional<double> number = parse_number(found);
    if (!number) return error("expected a number, found " + in_quotes(found));
    if (!std::isfinite(*number))
      return error("the coordinate " + in_quotes(found) + " is not finite");
    out[i] = *number;
  }
  return {};
}

}  // namespace pmesh
