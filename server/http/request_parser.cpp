#include "server/http/request_parser.h"

#include <algorithm>
#include <iterator>

#include <boost/asio/buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

namespace pmesh {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

constexpr std::string_view kLineEnd = "\r\n";
constexpr std::string_view kHeadEnd = "\r\n\r\n";

/// Empty lines before a request are let pass (RFC 9112, 2.2), but not for ever.
constexpr int kMostEmptyLines = 8;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_token_character(char c) {
  const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return is_letter || is_digit(c) ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_character);
}

/// Visible US-ASCII: what a target is made of.
bool is_visible(char c) { return c > ' ' && c < '\x7F'; }

/// What a field's value may hold: text, blanks, and bytes above US-ASCII.
bool is_value_character(char c) {
  return c == '\t' || (static_cast<unsigned char>(c) >= ' ' && c != '\x7F');
}

int check_request_line(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return 400;
  const std::string_view target = line.substr(first + 1, last - first - 1);
  if (!is_token(line.substr(0, first))) return 400;
  if (!std::all_of(target.begin(), target.end(), is_visible)) return 400;
  const std::string_view version = line.substr(last + 1);
  return version == "HTTP/1.1" || version == "HTTP/1.0" ? 0 : 400;
}

bool is_field_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return false;
  const std::string_view value = line.substr(colon + 1);
  return std::all_of(value.begin(), value.end(), is_value_character);
}

/// Takes a line off the front of `head`, which holds one.
std::string_view take_line(std::string_view& head) {
  const std::string_view line = head.substr(0, head.find(kLineEnd));
  head.remove_prefix(line.size() + kLineEnd.size());
  return line;
}

/// Whether the values of a field that must come once agree that the request has no body. An empty
/// or repeated one is no agreement.
bool says_no_body(const RequestParser::Message& message) {
  const auto [first, last] = message.equal_range(http::field::content_length);
  return first == last || (std::next(first) == last && first->value() == "0");
}

/// What the name of a host is made of: RFC 3986's unreserved characters, sub-delims and escapes.
bool is_name_character(char c) {
  return is_token_character(c) ? std::string_view("#^`|").find(c) == std::string::npos
                               : std::string_view("(),;=").find(c) != std::string::npos;
}

/// What stands in the brackets of an address.
bool is_literal_character(char c) { return c == ':' || (c != '%' && is_name_character(c)); }

/// Whether `text` is what may follow a host: nothing, or a colon and a port, which may be empty.
bool is_port(std::string_view text) {
  return text.empty() ||
         (text.front() == ':' && std::all_of(text.begin() + 1, text.end(), is_digit));
}

/// Whether `value` can be that of a Host field (RFC 9112, 3.2). An empty one can.
bool is_host(std::string_view value) {
  if (!value.starts_with('[')) {
    const std::string_view name = value.substr(0, value.find(':'));
    return std::all_of(name.begin(), name.end(), is_name_character) &&
           is_port(value.substr(name.size()));
  }
  const std::size_t end = value.find(']');
  if (end == std::string_view::npos) return false;
  const std::string_view address = value.substr(1, end - 1);
  return !address.empty() && std::all_of(address.begin(), address.end(), is_literal_character) &&
         is_port(value.substr(end + 1));
}

/// Whether Beast will accept it: then the answer is 101, and nothing else.
bool is_websocket_upgrade(const RequestParser::Message& message) {
  constexpr std::size_t kKeyCharacters = 24;  // 16 bytes in base64
  return boost::beast::websocket::is_upgrade(message) &&
         message[http::field::sec_websocket_version] == "13" &&
         message[http::field::sec_websocket_key].size() == kKeyCharacters;
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

RequestParser::Step RequestParser::next() {
  drop_last();
  while (searched_ == 0 && held_.starts_with(kLineEnd)) {
    if (++empty_lines_ > kMostEmptyLines) return refuse(400);
    held_.erase(0, kLineEnd.size());
  }
  const std::size_t found = held_.find(kHeadEnd, searched_);
  const std::size_t head_bytes =
      found == std::string::npos ? held_.size() : found + kHeadEnd.size();
  if (head_bytes > limits_.header_bytes) {
    // The whole of what may be a head is there: is it the line that is too long?
    const bool is_line = held_.find(kLineEnd) >= limits_.target_bytes;
    return is_line ? refuse(414, LimitName::target_bytes) : refuse(431, LimitName::header_bytes);
  }
  if (found == std::string::npos) {
    searched_ = held_.size() - std::min(held_.size(), kHeadEnd.size() - 1);
    return Step::more;
  }
  head_bytes_ = head_bytes;
  return parse_head(std::string_view(held_).substr(0, head_bytes));
}

/// Forgets the request that was given. An idle connection is to hold no memory.
void RequestParser::drop_last() {
  if (head_bytes_ == 0) return;
  held_.erase(0, head_bytes_);
  if (held_.empty()) held_ = std::string();
  parser_.reset();
  head_bytes_ = searched_ = 0;
  empty_lines_ = 0;
}

RequestParser::Step RequestParser::refuse(int status, std::optional<LimitName> limit) {
  refusal_ = status;
  limit_ = limit;
  return Step::refusal;
}

RequestParser::Step RequestParser::parse_head(std::string_view head) {
  if (const int refusal = check_head(head); refusal != 0) return refuse(refusal);
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(limits_.header_bytes));
  boost::system::error_code error;
  const std::size_t used = parser_->put(asio::buffer(head), error);
  if (error || used != head.size() || !parser_->is_header_done()) return refuse(400);
  return check_message();
}

RequestParser::Step RequestParser::check_message() {
  const Message& message = parser_->get();
  const auto fields = static_cast<std::size_t>(std::distance(message.begin(), message.end()));
  if (fields > limits_.header_fields) return refuse(431, LimitName::header_fields);
  const std::size_t hosts = message.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && message.version() >= 11)) return refuse(400);
  if (!is_host(message[http::field::host])) return refuse(400);
  if (message.count(http::field::transfer_encoding) > 0) return refuse(413);
  if (!says_no_body(message)) return refuse(413);
  if (message.target().size() > limits_.target_bytes) return refuse(414, LimitName::target_bytes);
  return Step::request;
}

HttpRequest RequestParser::request() const {
  const Message& message = parser_->get();
  const bool is_one_range =
      message.count(http::field::range) == 1 && message.count(http::field::if_range) <= 1;
  return {
      .method = message.method_string(),
      .target = message.target(),
      .range = is_one_range ? std::string_view(message[http::field::range]) : std::string_view(),
      .if_range = message[http::field::if_range],
      .if_none_match = list_of("If-None-Match"),
      .authorization = message[http::field::authorization],
      .upgrade = is_websocket_upgrade(message)};
}

/// The values of all fields of that name as one list (RFC 9110, 5.3).
std::string RequestParser::list_of(std::string_view name) const {
  std::string list;
  const auto [first, last] = message().equal_range({name.data(), name.size()});
  for (auto field = first; field != last; ++field) {
    if (!list.empty()) list.push_back(',');
    list.append(field->value());
  }
  return list;
}

}  // namespace pmesh
