#include "server/http/http_session.h"

#include <ctime>
#include <utility>

#include <boost/asio/post.hpp>

#include "server/access/signed_query.h"
#include "server/log/structured_log.h"

namespace pmesh {

namespace asio = boost::asio;

namespace {

using Clock = Deadline::Clock;

/// A body in memory of at most this size goes out in one piece with its head.
constexpr std::size_t kShortBytes = 4096;

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

std::string HttpSession::refusal_text() {
  const HttpAnswer answer = busy_answer(503, "too many connections");
  return head_text(answer, http_date(), false) + answer.text;
}

Awaitable<void> HttpSession::run() {
  bool goes_on = true;
  while (goes_on) {
    const Arrival arrival = co_await next_request();
    if (arrival.is_request) {
      goes_on = co_await answer_request();
    } else if (arrival.refusal != 0) {
      goes_on = co_await answer_refusal(arrival.refusal);
    } else {
      goes_on = false;
    }
  }
}

void HttpSession::on_drain() {
  if (idle_) channel_.interrupt_receive();
  if (websocket_) websocket_->drain();
}

// ---- receiving

Awaitable<HttpSession::Arrival> HttpSession::next_request() {
  RequestParser::Step step = parser_.next();
  idle_ = step == RequestParser::Step::more && parser_.empty();
  if (idle_ && draining()) co_return Arrival{};
  Clock::time_point by =
      Clock::now() + (idle_ && !is_first_ ? limits().idle_timeout : limits().header_timeout);
  const bool was_first = std::exchange(is_first_, false);
  while (step == RequestParser::Step::more) {
    const std::size_t count = co_await channel_.receive(buffer_, by);
    if (count == 0) co_return after_silence(was_first);
    parser_.feed({buffer_.data(), count});
    if (idle_) by = Clock::now() + limits().header_timeout;
    idle_ = false;
    step = parser_.next();
  }
  if (step == RequestParser::Step::refusal) co_return Arrival{false, parser_.refusal()};
  co_return Arrival{true, 0};
}

/// `is_first`: no request has come before.
HttpSession::Arrival HttpSession::after_silence(bool is_first) {
  if (!channel_.timed_out()) return {};
  if (!idle_) return {false, 408};
  metrics().limits.add(is_first ? LimitName::header_timeout : LimitName::idle_timeout);
  return {};
}

// ---- answering

/// False if the connection is over.
Awaitable<bool> HttpSession::answer_request() {
  const Clock::time_point begun = Clock::now();
  refresh_policy();
  const auto place = place_of_client();
  HttpAnswer answer = place ? judge() : busy_answer(429, "too many requests");
  if (!place) answer.limit = LimitName::connections_per_address;
  if (answer.lod_job) {
    answer.lod_job->client = counted_client();
    const LodOutcome outcome = co_await make_lod(*answer.lod_job);
    take_lod(answer, outcome);
  }
  const bool talks_too_soon = answer.status == 101 && !parser_.empty();
  if (talks_too_soon) {
    answer = error_answer(400, "a WebSocket begins after its 101");
    answer.route = RouteName::stream;
  }
  if (answer.status == 101) {
    record(answer, parser_.request(), begun);
    co_await become_websocket(answer.stream_id);
    co_return false;
  }
  const bool keep_alive = parser_.keep_alive() && !draining() && !talks_too_soon;
  const bool sent = co_await send(answer, keep_alive);
  record(answer, parser_.request(), begun);
  if (!sent) channel_.reset();
  if (sent && !keep_alive) co_await channel_.close_gently();
  co_return sent&& keep_alive;
}

Awaitable<bool> HttpSession::answer_refusal(int status) {
  HttpAnswer answer = error_answer(status, message_of(status));
  answer.limit = status == 408 ? LimitName::header_timeout : parser_.limit();
  const Clock::time_point begun = Clock::now();
  request_client_.reset();
  const bool sent = co_await send(answer, false);
  record(answer, {}, begun);
  if (sent) co_await channel_.close_gently();
  co_return false;
}

HttpAnswer HttpSession::judge() const {
  return answer_http(parser_.request(), {.store = services().store,
                                         .catalogue = services().catalogue,
                                         .access = policy().access,
                                         .limits = limits(),
                                         .most_lod_faces = services().most_lod_faces,
                                         .now = static_cast<std::uint64_t>(std::time(nullptr)),
                                         .metrics_text = services().metrics_text,
                                         .only_operation = services().only_operation});
}

/// The place that the client of a trusted proxy has for this request; nothing if it has too many
/// under way. Other clients have one for the whole connection.
std::optional<AddressCounts::Slot> HttpSession::place_of_client() {
  request_client_.reset();
  if (!services().proxies.contains(client())) return AddressCounts::Slot();
  request_client_ = services().proxies.client_of(client(), parser_.forwarded_for());
  const auto counted = counted_client();
  return counted ? services().addresses.enter(*counted) : AddressCounts::Slot();
}

boost::asio::ip::address HttpSession::client_of_request() const {
  return request_client_.value_or(client());
}

/// The same; nothing if that is a trusted proxy, which may stand for any number of clients.
std::optional<boost::asio::ip::address> HttpSession::counted_client() const {
  const auto from = client_of_request();
  return services().proxies.contains(from) ? std::nullopt : std::optional(from);
}

/// Waits for a worker to be done with the job.
Awaitable<LodOutcome> HttpSession::make_lod(const LodJob& job) {
  constexpr asio::use_awaitable_t<Executor> kToken;
  const auto initiate = [this, &job](auto handler) {
    const auto shared = std::make_shared<decltype(handler)>(std::move(handler));
    services().lod.get(job, [shared, executor = channel_.executor()](const LodOutcome& outcome) {
      asio::post(executor, [shared, outcome] { std::move (*shared)(outcome); });
    });
  };
  LodOutcome outcome =
      co_await asio::async_initiate<const asio::use_awaitable_t<Executor>&, void(LodOutcome)>(
          initiate, kToken);
  co_return outcome;
}

/// False if the connection must be cut: the peer has not got the whole answer.
Awaitable<bool> HttpSession::send(const HttpAnswer& answer, bool keep_alive) {
  std::string head = head_text(answer, http_date(), keep_alive);
  const bool has_body = answer.may_have_body() && !answer.head_only;
  const ByteView body = has_body ? answer.body() : ByteView();
  const bool is_short = body.size() <= kShortBytes;
  if (is_short) head.append(body.begin(), body.end());
  Channel::Parcel parcel{as_bytes(head)};
  if (has_body && answer.mesh) parcel = {as_bytes(head), answer.mesh.get(), answer.span};
  const WireStep::Kind need = channel_.push(parcel);
  bool sent = need == WireStep::moved;
  if (!sent) sent = co_await channel_.send_rest(parcel, need);
  if (sent && !is_short) {
    parcel = {body};
    sent = co_await channel_.send(parcel);
  }
  co_return sent;
}

void HttpSession::record(const HttpAnswer& answer, const HttpRequest& request,
                         Clock::time_point begun) {
  const Clock::duration duration = Clock::now() - begun;
  metrics().requests.add(answer.route, answer.status);
  metrics().durations.add(duration);
  if (answer.limit) metrics().limits.add(*answer.limit);
  if (answer.mesh && !answer.mesh->recently_intact()) ++metrics().broken_files;
  count_sent_bytes();
  if (policy().access_log) log(answer, request, duration);
}

/// A line about the answer. What was no request has neither method nor target.
void HttpSession::log(const HttpAnswer& answer, const HttpRequest& request,
                      Clock::duration duration) const {
  const std::string from = client_of_request().to_string();
  const std::string target = hide_signatures(request.target);
  log_event(spdlog::level::info, "answered",
            {{"client", std::string_view(from)},
             {"method", request.method},
             {"target", std::string_view(target)},
             {"status", std::int64_t{answer.status}},
             {"bytes", answer.head_only ? 0 : answer.body_bytes()},
             {"seconds", std::chrono::duration<double>(duration).count()}});
}

Awaitable<void> HttpSession::become_websocket(const std::string& id) {
  become(WireProtocol::websocket);
  const HttpRequest request = parser_.request();
  const std::size_t question = std::min(request.target.find('?'), request.target.size() - 1);
  websocket_ = std::make_unique<WebSocketSession>(
      channel_, services(), policy_pointer(), client_of_request().to_string(),
      FrameCredentials{.authorization = std::string(request.authorization),
                       .id = id,
                       .query = std::string(request.target.substr(question + 1))});
  if (draining()) websocket_->drain();
  const std::shared_ptr<void> owner = shared_from_this();
  co_await websocket_->run(parser_.message(), owner);
}

}  // namespace pmesh
