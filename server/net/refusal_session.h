// The shortest of sessions: says why there is no other, and ends.
#pragma once

#include <string>
#include <utility>

#include "server/net/session.h"

namespace pmesh {

class RefusalSession final : public Session {
 public:
  RefusalSession(boost::asio::ip::tcp::socket socket, const SessionLimits& limits, std::string text)
      : Session(std::move(socket), limits), text_(std::move(text)) {}

 protected:
  boost::asio::awaitable<void> run() override;
  void on_drain() override {}

 private:
  std::string text_;
};

}  // namespace pmesh
