// An HTTP/1.1 connection: requests are parsed by Beast, one at a time, and each is answered exactly
// once by what server/http/http_answer.h says.
#pragma once

#include <optional>
#include <string>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>

#include "server/http/http_answer.h"
#include "server/net/session.h"

namespace pmesh {

class HttpSession final : public Session {
 public:
  HttpSession(boost::asio::ip::tcp::socket socket, const SessionLimits& limits, MeshStore& store)
      : Session(std::move(socket), limits), store_(store) {}

 protected:
  boost::asio::awaitable<void> run() override;
  void on_drain() override;

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  /// What came of waiting for a request.
  struct Arrival {
    enum Kind { request, refusal, end } kind = end;
    int status = 0;  ///< Of a refusal: what arrived is answered by this and the connection closed.
  };

  boost::asio::awaitable<Arrival> next_request();
  boost::asio::awaitable<std::size_t> receive_more(Deadline::Clock::time_point by);
  Arrival parse_input();
  Arrival refusal_of(const boost::system::error_code& error) const;
  Arrival checked_request() const;
  HttpRequest request() const;
  boost::asio::awaitable<bool> send(const HttpAnswer& answer, bool keep_alive);

  MeshStore& store_;
  std::optional<Parser> parser_;
  std::string input_;  // received and not yet parsed
  bool idle_ = false;  // between requests
};

}  // namespace pmesh
