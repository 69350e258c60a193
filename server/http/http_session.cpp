#include "server/http/http_session.h"

#include <ctime>
#include <iterator>

#include <boost/asio/buffer.hpp>

namespace pmesh {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

constexpr std::size_t kReceiveBytes = 2048;

/// Now, as the Date field has it; remade once a second on each thread.
const std::string& http_date() {
  thread_local std::time_t made = 0;
  thread_local std::string text;
  const std::time_t now = std::time(nullptr);
  if (now == made) return text;
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char buffer[64];
  text.assign(buffer, std::strftime(buffer, sizeof buffer, "%a, %d %b %Y %H:%M:%S GMT", &utc));
  made = now;
  return text;
}

std::string_view message_of(int status) {
  switch (status) {
    case 408:
      return "the request took too long";
    case 413:
      return "requests must have no body";
    case 414:
      return "the request target is too long";
    case 431:
      return "the request header is too large";
    default:
      return "the request is malformed";
  }
}

}  // namespace

asio::awaitable<void> HttpSession::run() {
  bool keep_alive = true;
  while (keep_alive) {
    const Arrival arrival = co_await next_request();
    if (arrival.kind == Arrival::end) co_return;
    HttpAnswer answer;
    if (arrival.kind == Arrival::refusal) {
      answer = error_answer(arrival.status, message_of(arrival.status));
      keep_alive = false;
    } else {
      answer = answer_http(request(), store_);
      keep_alive = parser_->get().keep_alive() && !draining();
    }
    const bool sent = co_await send(answer, keep_alive);
    if (!sent) {
      channel_.reset();
      co_return;
    }
  }
  co_await channel_.close_gently();
}

void HttpSession::on_drain() {
  if (idle_) channel_.interrupt_receive();
}

asio::awaitable<HttpSession::Arrival> HttpSession::next_request() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(limits().header_bytes));
  idle_ = input_.empty();
  if (idle_) {
    if (draining()) co_return Arrival{};
    const std::size_t count = co_await receive_more(Deadline::Clock::now() + limits().idle_timeout);
    if (count == 0) co_return Arrival{};
    idle_ = false;
  }
  const auto by = Deadline::Clock::now() + limits().header_timeout;
  while (true) {
    const Arrival arrival = parse_input();
    if (arrival.kind != Arrival::end) co_return arrival;
    const std::size_t count = co_await receive_more(by);
    if (count == 0) {
      co_return channel_.timed_out() ? Arrival{Arrival::refusal, 408} : Arrival{};
    }
  }
}

/// Appends what arrives to the input.
asio::awaitable<std::size_t> HttpSession::receive_more(Deadline::Clock::time_point by) {
  const std::size_t held = input_.size();
  input_.resize(held + kReceiveBytes);
  const std::size_t count =
      co_await channel_.receive(std::span(input_).subspan(held, kReceiveBytes), by);
  input_.resize(held + count);
  co_return count;
}

/// Parses the input; `end` if the request is not whole yet.
HttpSession::Arrival HttpSession::parse_input() {
  boost::system::error_code error;
  const std::size_t used = parser_->put(asio::buffer(input_), error);
  if (error == http::error::need_more) {
    input_.erase(0, used);
    return {};
  }
  if (error) return refusal_of(error);
  input_.erase(0, used);
  return checked_request();
}

HttpSession::Arrival HttpSession::refusal_of(const boost::system::error_code& error) const {
  if (error != http::error::header_limit) return {Arrival::refusal, 400};
  // Beast takes the first line only when it is whole: is that what did not end?
  const bool line_is_whole =
      !parser_->get().target().empty() || input_.find("\r\n") < kMaxTargetBytes;
  return {Arrival::refusal, line_is_whole ? 431 : 414};
}

/// The rules that Beast leaves to its user.
HttpSession::Arrival HttpSession::checked_request() const {
  const auto& message = parser_->get();
  if (static_cast<std::size_t>(std::distance(message.begin(), message.end())) >
      limits().header_fields) {
    return {Arrival::refusal, 431};
  }
  const std::size_t hosts = message.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && message.version() >= 11)) return {Arrival::refusal, 400};
  if (message.count(http::field::transfer_encoding) > 0) return {Arrival::refusal, 413};
  if (parser_->content_length().value_or(0) > 0) return {Arrival::refusal, 413};
  return {Arrival::request, 0};
}

HttpRequest HttpSession::request() const {
  const auto& message = parser_->get();
  return {.method = message.method_string(),
          .target = message.target(),
          .range = message[http::field::range],
          .if_range = message[http::field::if_range],
          .if_none_match = message[http::field::if_none_match]};
}

/// False if the connection must be cut: the peer has not got the whole answer.
asio::awaitable<bool> HttpSession::send(const HttpAnswer& answer, bool keep_alive) {
  std::string head = head_text(answer, http_date(), keep_alive);
  const bool has_body = answer.may_have_body() && !answer.head_only && answer.body_bytes() > 0;
  if (has_body && !answer.mesh) head += answer.text;
  const bool file_follows = has_body && answer.mesh;
  bool sent = co_await channel_.send(as_bytes(head), file_follows);
  if (sent && file_follows) {
    sent = co_await channel_.send_file(*answer.mesh, answer.span);
  }
  co_return sent;
}

}  // namespace pmesh
