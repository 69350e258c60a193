// An HTTP/1.1 connection: one request at a time, each answered exactly once by what
// server/http/http_answer.h says. A request for a WebSocket makes it one.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "server/http/http_answer.h"
#include "server/http/request_parser.h"
#include "server/http/websocket_session.h"
#include "server/net/session.h"

namespace pmesh {

class HttpSession final : public Session {
 public:
  HttpSession(Socket socket, Services& services, AddressCounts::Slot slot)
      : Session(std::move(socket), services, WireProtocol::http, std::move(slot)) {}

  /// What a client is told that there is no room for.
  static std::string refusal_text();

 protected:
  Awaitable<void> run() override;
  void on_drain() override;
  std::string refusal() const override { return refusal_text(); }

 private:
  /// What came of waiting for a request: one, an answer to what is none, or the end.
  struct Arrival {
    bool is_request = false;
    int refusal = 0;
  };

  Awaitable<Arrival> next_request();
  Arrival after_silence(bool is_first);
  Awaitable<bool> answer_request();
  Awaitable<bool> answer_refusal(int status);
  HttpAnswer judge() const;
  std::optional<AddressCounts::Slot> place_of_client();
  Awaitable<LodOutcome> make_lod(const LodJob& job);
  Awaitable<bool> send(const HttpAnswer& answer, bool keep_alive);
  void record(const HttpAnswer& answer, const HttpRequest& request,
              Deadline::Clock::time_point begun);
  void log(const HttpAnswer& answer, const HttpRequest& request,
           Deadline::Clock::duration duration) const;
  boost::asio::ip::address client_of_request() const;
  std::optional<boost::asio::ip::address> counted_client() const;
  Awaitable<void> become_websocket(const std::string& id);

  RequestParser parser_{limits()};
  std::array<char, 512> buffer_;                            // an idle connection holds it too
  std::optional<boost::asio::ip::address> request_client_;  // if a proxy has passed it on
  std::unique_ptr<WebSocketSession> websocket_;
  bool is_first_ = true;  // no request has come yet
  bool idle_ = false;     // between requests
};

}  // namespace pmesh
