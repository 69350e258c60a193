#include "server/net/deadline.h"

namespace pmesh {

Deadline::Deadline(const Executor& executor, std::function<void()> reached)
    : timer_(executor), reached_(std::move(reached)) {}

void Deadline::set(Clock::time_point when) {
  when_ = when;
  if (reached_ && when_ < wakes_) sleep();
}

void Deadline::stop() {
  clear();
  reached_ = nullptr;
  timer_.cancel();
}

void Deadline::sleep() {
  wakes_ = when_;
  timer_.expires_at(when_);  // ends an earlier wait
  timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (error || !self->reached_) return;
    self->wakes_ = Clock::time_point::max();
    if (self->when_ > Clock::now()) {
      if (self->when_ != Clock::time_point::max()) self->sleep();
      return;
    }
    self->clear();
    const auto reached = self->reached_;  // which may stop this deadline, and lose it
    reached();
  });
}

}  // namespace pmesh
