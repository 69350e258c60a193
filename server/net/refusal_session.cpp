#include "server/net/refusal_session.h"

namespace pmesh {

boost::asio::awaitable<void> RefusalSession::run() {
  const bool sent = co_await channel_.send(as_bytes(text_));
  if (sent) co_await channel_.close_gently();
}

}  // namespace pmesh
