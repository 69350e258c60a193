#include "server/net/refusal_session.h"

namespace pmesh {

Awaitable<void> RefusalSession::run() {
  const Channel::Parcel parcel{as_bytes(text_)};
  const bool sent = co_await channel_.send(parcel);
  if (sent) co_await channel_.close_gently();
}

}  // namespace pmesh
