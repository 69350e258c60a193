#include "server/http/request_parser.h"

#include <algorithm>

#include <boost/asio/buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include "server/http/head_syntax.h"

namespace pmesh {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

constexpr std::string_view kLineEnd = "\r\n";
constexpr std::string_view kHeadEnd = "\r\n\r\n";

/// Empty lines before a request are let pass (RFC 9112, 2.2), but not for ever.
constexpr int kMostEmptyLines = 8;

/// Fields of one name are one list (RFC 9110, 5.3).
void append_to_list(std::string& list, std::string_view value) {
  if (!list.empty()) list.push_back(',');
  list.append(value);
}

/// Whether Beast will accept it: then the answer is 101, and nothing else.
bool is_websocket_upgrade(const RequestParser::Message& message) {
  constexpr std::size_t kKeyCharacters = 24;  // 16 bytes in base64
  return boost::beast::websocket::is_upgrade(message) &&
         message[http::field::sec_websocket_version] == "13" &&
         message[http::field::sec_websocket_key].size() == kKeyCharacters;
}

}  // namespace

/// What there is once, or too often.
struct RequestParser::FieldCounts {
  std::size_t all = 0, hosts = 0, transfer_encodings = 0, lengths = 0, ranges = 0, if_ranges = 0;
  std::string_view host{}, content_length{};  // the last ones
  bool upgrades = false;
};

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
  request_ = {};
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

/// In one pass: a search takes longer than to look at all of the few fields that there are.
RequestParser::Step RequestParser::check_message() {
  const Message& message = parser_->get();
  request_.method = message.method_string();
  request_.target = message.target();
  FieldCounts counts;
  for (const auto& field : message) take_field(field.name(), field.value(), counts);
  if (counts.all > limits_.header_fields) return refuse(431, LimitName::header_fields);
  const bool has_host = counts.hosts == 1 || (counts.hosts == 0 && message.version() < 11);
  if (!has_host || !is_host(counts.host)) return refuse(400);
  // Neither an empty nor a repeated length is a clear word that there is no body.
  const bool has_no_body =
      counts.lengths == 0 || (counts.lengths == 1 && counts.content_length == "0");
  if (counts.transfer_encodings > 0 || !has_no_body) return refuse(413);
  if (request_.target.size() > limits_.target_bytes) return refuse(414, LimitName::target_bytes);
  if (counts.ranges > 1 || counts.if_ranges > 1) request_.range = {};
  request_.upgrade = counts.upgrades && is_websocket_upgrade(message);
  return Step::request;
}

void RequestParser::take_field(http::field name, std::string_view value, FieldCounts& counts) {
  ++counts.all;
  switch (name) {
    case http::field::host:
      ++counts.hosts;
      counts.host = value;
      break;
    case http::field::transfer_encoding:
      ++counts.transfer_encodings;
      break;
    case http::field::content_length:
      ++counts.lengths;
      counts.content_length = value;
      break;
    case http::field::range:
      ++counts.ranges;
      request_.range = value;
      break;
    case http::field::if_range:
      ++counts.if_ranges;
      request_.if_range = value;
      break;
    case http::field::if_none_match:
      append_to_list(request_.if_none_match, value);
      break;
    case http::field::authorization:
      if (request_.authorization.empty()) request_.authorization = value;
      break;
    case http::field::upgrade:
      counts.upgrades = true;
      break;
    default:
      break;
  }
}

std::string RequestParser::forwarded_for() const {
  std::string list;
  const auto [first, last] = message().equal_range("X-Forwarded-For");
  for (auto field = first; field != last; ++field) append_to_list(list, field->value());
  return list;
}

}  // namespace pmesh
