#include "tests/proxy/session.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>

namespace pmesh::test {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;

namespace {

constexpr auto kAwait = asio::as_tuple(asio::use_awaitable);
constexpr std::size_t kBlockBytes = 64 * 1024;
// Stalls have dice of their own: which segments there are depends on timing.
constexpr std::uint64_t kStallSeedDown = 0x646F776E;
constexpr std::uint64_t kStallSeedUp = 0x7570;

constexpr std::string_view kBadGateway =
    "HTTP/1.1 502 Bad Gateway\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";

template <class Head>
std::string text_of(const Head& head) {
  std::ostringstream text;
  text << head.base();
  return text.str();
}

}  // namespace

ProxySession::ProxySession(Socket client, const ProxyOptions& options, std::uint64_t number,
                           SharedCounts& counts)
    : options_(options),
      counts_(counts),
      random_(options.seed, number),
      client_(std::move(client)),
      upstream_(client_.get_executor()),
      down_(client_, {options.link.bits_per_second_down, options.link, &ProxyCounts::bytes_down},
            Random(options.seed ^ kStallSeedDown, number), counts),
      up_(upstream_, {options.link.bits_per_second_up, options.link, &ProxyCounts::bytes_up},
          Random(options.seed ^ kStallSeedUp, number), counts) {
  const bool is_to_break = random_.chance(options.reset_probability);
  const std::uint64_t bytes = 1 + random_.below(std::max<std::uint64_t>(options.reset_bytes, 1));
  if (is_to_break) down_.burst_after(bytes, [this] { reset(); });
}

void ProxySession::start() {
  asio::co_spawn(
      client_.get_executor(), [self = shared_from_this()] { return self->run(); }, asio::detached);
}

asio::awaitable<void> ProxySession::run() {
  const tcp::endpoint upstream(asio::ip::address_v4::loopback(), options_.upstream_port);
  const auto [error] = co_await upstream_.async_connect(upstream, kAwait);
  if (error) co_return;
  boost::system::error_code ignored;
  client_.set_option(tcp::no_delay(true), ignored);
  upstream_.set_option(tcp::no_delay(true), ignored);
  for (Pipe* pipe : {&down_, &up_}) {
    asio::co_spawn(
        client_.get_executor(), [self = shared_from_this(), pipe] { return self->deliver(*pipe); },
        asio::detached);
  }
  if (options_.is_http) {
    co_await exchange_http();
  } else {
    co_await pass_all();
  }
}

asio::awaitable<void> ProxySession::deliver(Pipe& pipe) {
  const bool is_whole = co_await pipe.deliver();
  if (!is_whole) close();
}

// Passes everything both ways until both sides have ended.
asio::awaitable<void> ProxySession::pass_all() {
  asio::co_spawn(
      client_.get_executor(),
      [self = shared_from_this()] { return self->pump(self->client_, self->up_); }, asio::detached);
  co_await pump(upstream_, down_);
}

asio::awaitable<void> ProxySession::pump(Socket& from, Pipe& pipe) {
  std::array<std::uint8_t, kBlockBytes> block;
  for (bool is_open = true; is_open;) {
    const auto [error, count] = co_await from.async_read_some(asio::buffer(block), kAwait);
    if (error) break;
    is_open = co_await pipe.send(ByteView(block).first(count));
  }
  co_await pipe.finish();
}

asio::awaitable<void> ProxySession::exchange_http() {
  for (bool goes_on = true; goes_on;) {
    Fate fate = roll();
    goes_on = co_await pass_request(fate);
    if (goes_on) goes_on = co_await pass_response(fate);
  }
  co_await down_.finish();
  co_await up_.finish();
}

// As many throws for every exchange, whatever it is.
ProxySession::Fate ProxySession::roll() {
  Fate fate;
  fate.is_bad_gateway = random_.chance(options_.bad_gateway_probability);
  fate.is_range_dropped = random_.chance(options_.drop_range_probability);
  fate.is_short = random_.chance(options_.short_body_probability);
  fate.cut = random_.below(std::max<std::uint64_t>(options_.short_bytes, 1));
  return fate;
}

// False if the upstream has nothing to answer.
asio::awaitable<bool> ProxySession::pass_request(Fate& fate) {
  http::request_parser<http::empty_body> request;
  const auto [error, _] = co_await http::async_read_header(client_, from_client_, request, kAwait);
  if (error) co_return false;
  if (fate.is_bad_gateway) {
    counts_.add(&ProxyCounts::bad_gateways);
    co_await down_.send(as_bytes(kBadGateway));
    co_return false;
  }
  is_head_request_ = request.get().method() == http::verb::head;
  is_last_request_ = !request.get().keep_alive();
  if (fate.is_range_dropped && request.get().erase(http::field::range) > 0) {
    counts_.add(&ProxyCounts::dropped_ranges);
  }
  const std::string text = text_of(request.get());
  const bool is_sent = co_await up_.send(as_bytes(text));
  co_return is_sent;
}

// False if that was the connection's last.
asio::awaitable<bool> ProxySession::pass_response(const Fate& fate) {
  http::response_parser<http::empty_body> response;
  response.skip(is_head_request_);
  response.body_limit(boost::none);
  const auto [error, _] =
      co_await http::async_read_header(upstream_, from_upstream_, response, kAwait);
  if (error) co_return false;
  const std::string text = text_of(response.get());
  const bool is_sent = co_await down_.send(as_bytes(text));
  if (!is_sent) co_return false;
  const unsigned status = response.get().result_int();
  const bool is_bodiless = is_head_request_ || status == 204 || status == 304;
  const auto length = response.content_length();
  if (status == 101 || (!length && !is_bodiless)) {  // what follows is not HTTP, or has no end
    const bool is_up = co_await pass_unread(from_client_, up_, UINT64_MAX);
    const bool is_down = co_await pass_unread(from_upstream_, down_, UINT64_MAX);
    if (is_up && is_down) co_await pass_all();
    co_return false;
  }
  const bool is_whole = co_await pass_body(is_bodiless ? 0 : *length, fate);
  const bool is_last = is_last_request_ || !response.get().keep_alive();
  if (is_last) co_return false;
  co_return is_whole;
}

asio::awaitable<bool> ProxySession::pass_body(std::uint64_t length, const Fate& fate) {
  const bool is_short = fate.is_short && length > 0;
  std::uint64_t left = is_short ? std::min(fate.cut, length - 1) : length;
  while (left > 0) {
    if (from_upstream_.size() == 0) {
      const auto space = from_upstream_.prepare(kBlockBytes);
      const auto [error, count] = co_await upstream_.async_read_some(space, kAwait);
      if (error) co_return false;
      from_upstream_.commit(count);
    }
    const std::size_t before = from_upstream_.size();
    const bool is_sent = co_await pass_unread(from_upstream_, down_, left);
    if (!is_sent) co_return false;
    left -= before - from_upstream_.size();
  }
  if (is_short) counts_.add(&ProxyCounts::short_bodies);
  co_return !is_short;
}

asio::awaitable<bool> ProxySession::pass_unread(boost::beast::flat_buffer& unread, Pipe& pipe,
                                                std::uint64_t most) {
  const std::size_t count = std::min<std::uint64_t>(unread.size(), most);
  const ByteView bytes(static_cast<const std::uint8_t*>(unread.data().data()), count);
  const bool is_sent = co_await pipe.send(bytes);
  unread.consume(count);
  co_return is_sent;
}

// Closes both sides by a RST.
void ProxySession::reset() {
  counts_.add(&ProxyCounts::resets);
  boost::system::error_code ignored;
  client_.set_option(asio::socket_base::linger(true, 0), ignored);
  close();
}

void ProxySession::close() {
  boost::system::error_code ignored;
  client_.close(ignored);
  upstream_.close(ignored);
}

}  // namespace pmesh::test
