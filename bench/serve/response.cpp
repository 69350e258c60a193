#include "bench/serve/response.h"

namespace pmesh::bench {
namespace {

constexpr std::string_view kLength = "\r\nContent-Length: ";

}  // namespace

Response::Step Response::feed(std::string_view bytes) {
  return status_ == 0 ? take_head(bytes) : take_body(bytes);
}

Response::Step Response::take_head(std::string_view bytes) {
  const std::size_t held = head_.size();
  head_.append(bytes);
  const std::size_t end = head_.find("\r\n\r\n");
  if (end == std::string::npos) return Step::more;
  bytes.remove_prefix(end + 4 - held);
  head_.resize(end + 2);
  const std::size_t length = head_.find(kLength);
  if (!head_.starts_with("HTTP/1.1 ") || length == std::string::npos) return Step::bad;
  const std::size_t digits = length + kLength.size();
  status_ = std::stoi(head_.substr(9, 3));
  body_bytes_ = std::stoull(head_.substr(digits, head_.find('\r', digits) - digits));
  return take_body(bytes);
}

Response::Step Response::take_body(std::string_view bytes) {
  if (bytes.size() > body_bytes_ - taken_) return Step::bad;
  const bool known = !expected_.empty() && (status_ == 200 || status_ == 206);
  if (known &&
      (body_bytes_ != expected_.size() || expected_.substr(taken_, bytes.size()) != bytes)) {
    return Step::bad;
  }
  taken_ += bytes.size();
  return taken_ == body_bytes_ ? Step::done : Step::more;
}

}  // namespace pmesh::bench
