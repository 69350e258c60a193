#include "server/net/session_registry.h"

namespace pmesh {

void SessionRegistry::start(const std::shared_ptr<Session>& session) {
  bool draining = false;
  {
    const std::lock_guard lock(mutex_);
    sessions_.insert(session);
    draining = emptied_ != nullptr;
  }
  ++count_;
  try {
    session->start([this, session] { remove(session); });
  } catch (...) {
    remove(session);
    throw;
  }
  if (draining) session->drain();
}

void SessionRegistry::remove(const std::shared_ptr<Session>& session) {
  --count_;
  std::function<void()> emptied;
  {
    const std::lock_guard lock(mutex_);
    sessions_.erase(session);
    if (sessions_.empty()) emptied = emptied_;
  }
  if (emptied) emptied();
}

void SessionRegistry::drain(std::function<void()> emptied) {
  bool empty = false;
  {
    const std::lock_guard lock(mutex_);
    emptied_ = emptied;
    empty = sessions_.empty();
    for (const auto& session : sessions_) session->drain();
  }
  if (empty) emptied();
}

void SessionRegistry::cut() {
  const std::lock_guard lock(mutex_);
  for (const auto& session : sessions_) session->cut();
}

}  // namespace pmesh
