// The bytes of an HTTP/1.1 connection as requests, one by one, without sockets. Beast parses; what
// it lets pass and an intermediary might read otherwise is refused here, so that no two of them
// ever see different requests (RFC 9112, section 11.2).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>

#include "server/http/http_answer.h"
#include "server/options.h"

namespace pmesh {

/// Memory: at most SessionLimits::header_bytes, and what the last feed() brought; none while no
/// byte of a request has come. Threads: belongs to one at a time.
class RequestParser {
 public:
  using Message = boost::beast::http::request<boost::beast::http::empty_body>;

  explicit RequestParser(const SessionLimits& limits) : limits_(limits) {}

  enum class Step : std::uint8_t {
    more,     ///< No request is whole yet.
    request,  ///< request() is the next one.
    refusal,  ///< What came is answered by refusal() and the connection closed.
  };

  /// Takes the bytes that follow those before. Then call next().
  void feed(std::string_view bytes) { held_.append(bytes); }
  /// Goes on to the next request, which may have been fed along with the last one.
  Step next();

  /// True if no byte of a request is held that next() has not given.
  bool empty() const { return held_.size() == head_bytes_; }

  /// Both are valid until the next call of feed() or next(). Precondition: next() gave a request.
  const HttpRequest& request() const { return request_; }
  const Message& message() const { return parser_->get(); }
  /// All X-Forwarded-For fields as one list. Precondition: as request().
  std::string forwarded_for() const;
  bool keep_alive() const { return message().keep_alive(); }

  /// The status; 0 if nothing was refused.
  int refusal() const { return refusal_; }
  /// The limit that was met, if the refusal is for one.
  std::optional<LimitName> limit() const { return limit_; }

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  struct FieldCounts;

  void drop_last();
  Step refuse(int status, std::optional<LimitName> limit = {});
  Step parse_head(std::string_view head);
  Step check_message();
  void take_field(boost::beast::http::field name, std::string_view value, FieldCounts& counts);

  const SessionLimits limits_;
  std::optional<Parser> parser_;
  HttpRequest request_;
  std::string held_;            // the last request's head, and what came after it
  std::size_t head_bytes_ = 0;  // of the last request given
  std::size_t searched_ = 0;    // no head ends before this
  int empty_lines_ = 0;         // before the next request
  int refusal_ = 0;
  std::optional<LimitName> limit_;
};

}  // namespace pmesh
