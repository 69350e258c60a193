// The shortest of sessions: says why there is no other, and ends.
#pragma once

#include <string>
#include <utility>

#include "server/net/session.h"

namespace pmesh {

class RefusalSession final : public Session {
 public:
  RefusalSession(Socket socket, Services& services, WireProtocol protocol, std::string text)
      : Session(std::move(socket), services, protocol, {}), text_(std::move(text)) {}

 protected:
  Awaitable<void> run() override;
  void on_drain() override {}
  std::string refusal() const override { return text_; }

 private:
  std::string text_;
};

}  // namespace pmesh
