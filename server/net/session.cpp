#include "server/net/session.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/post.hpp>
#include <spdlog/spdlog.h>

namespace pmesh {

namespace asio = boost::asio;

void log_exception(std::string_view what, const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const std::exception& error) {
    spdlog::error("{} failed: {}", what, error.what());
  } catch (...) {
    spdlog::error("{} failed", what);
  }
}

void Session::start(std::function<void()> ended) {
  asio::co_spawn(
      channel_.executor(), run(),
      [self = shared_from_this(), ended = std::move(ended)](const std::exception_ptr& exception) {
        if (exception) log_exception("a session", exception);
        self->channel_.close();
        ended();
      });
}

void Session::drain() {
  asio::post(channel_.executor(), [self = shared_from_this()] {
    self->draining_ = true;
    self->on_drain();
  });
}

void Session::cut() {
  asio::post(channel_.executor(), [self = shared_from_this()] { self->channel_.reset(); });
}

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
