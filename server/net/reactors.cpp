#include "server/net/reactors.h"

#include <algorithm>
#include <thread>

#include <spdlog/spdlog.h>

namespace pmesh {

Reactors::Reactors(unsigned threads) {
  const unsigned count = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < count; ++i) {
    contexts_.push_back(
        std::make_unique<boost::asio::io_context>(BOOST_ASIO_CONCURRENCY_HINT_UNSAFE_IO));
    work_.push_back(boost::asio::make_work_guard(*contexts_.back()));
  }
}

Reactors::~Reactors() {
  work_.clear();
  while (!contexts_.empty()) contexts_.pop_back();
}

boost::asio::io_context& Reactors::next() {
  return *contexts_[turn_.fetch_add(1, std::memory_order_relaxed) % contexts_.size()];
}

void Reactors::run() {
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < contexts_.size(); ++i) {
    threads.emplace_back([this, i] { run(*contexts_[i]); });
  }
  run(first());
  for (std::thread& thread : threads) thread.join();
}

/// A handler that fails, for want of memory, ends what it was for and not the server.
void Reactors::run(boost::asio::io_context& context) {
  while (!context.stopped()) {
    try {
      context.run();
    } catch (const std::exception& error) {
      spdlog::error("a handler failed: {}", error.what());
    }
  }
}

void Reactors::stop() {
  for (const auto& context : contexts_) context->stop();
}

}  // namespace pmesh
