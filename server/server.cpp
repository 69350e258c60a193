#include "server/server.h"

#include <algorithm>
#include <csignal>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/system/system_error.hpp>
#include <spdlog/spdlog.h>

#include "protocol/messages.h"
#include "server/http/http_answer.h"
#include "server/http/http_session.h"
#include "server/net/listener.h"
#include "server/store/mesh_store.h"
#include "server/net/refusal_session.h"
#include "server/net/session.h"
#include "server/frames/tcp_session.h"

namespace pmesh {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

unsigned thread_count(unsigned asked) {
  return asked > 0 ? asked : std::max(1u, std::thread::hardware_concurrency());
}

/// What an HTTP client beyond the limit is told. It is made once, so it has no Date.
std::string http_refusal() {
  const std::string text = "too many connections\n";
  return "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 1\r\nCache-Control: no-store\r\n"
         "Content-Type: text/plain; charset=utf-8\r\nContent-Length: " +
         std::to_string(text.size()) + "\r\nConnection: close\r\n\r\n" + text;
}

std::string tcp_refusal() {
  Bytes frames = encode_hello({.max_frame = kMinFrameLimit});
  const Bytes busy = encode_failure(kConnectionStream, {FailureCode::busy, "too many connections"});
  frames.insert(frames.end(), busy.begin(), busy.end());
  return {frames.begin(), frames.end()};
}

}  // namespace

class Server::Impl {
 public:
  explicit Impl(const ServerOptions& options)
      : options_(options),
        context_(static_cast<int>(thread_count(options.threads))),
        control_(asio::make_strand(context_)),
        signals_(control_),
        grace_(control_),
        registry_(options.max_connections) {}

  Status open_store() {
    auto store = MeshStore::open(options_.directory);
    if (!store) return store.error();
    store_ = std::move(*store);
    return {};
  }

  template <class SessionType>
  Result<std::string> listen(const std::string& address, const std::string& refusal) {
    const auto make_session = [this](tcp::socket socket) -> std::shared_ptr<Session> {
      return std::make_shared<SessionType>(std::move(socket), options_.limits, *store_);
    };
    const auto make_refusal = [this, refusal](tcp::socket socket) -> std::shared_ptr<Session> {
      return std::make_shared<RefusalSession>(std::move(socket), options_.limits, refusal);
    };
    auto listener = Listener::bind(context_, address, registry_, make_session, make_refusal);
    if (!listener) return listener.error();
    listeners_.push_back(*listener);
    return (*listener)->address();
  }

  void handle_signals() {
    signals_.add(SIGTERM);
    signals_.add(SIGINT);
    wait_for_signal();
  }

  void run() {
    for (const auto& listener : listeners_) listener->start();
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < thread_count(options_.threads); ++i) {
      threads.emplace_back([this] { context_.run(); });
    }
    context_.run();
    for (std::thread& thread : threads) thread.join();
  }

  void drain() {
    asio::post(control_, [this] { begin_drain(); });
  }

  void stop() { context_.stop(); }

 private:
  void wait_for_signal() {
    signals_.async_wait([this](const boost::system::error_code& error, int number) {
      if (error) return;
      spdlog::info("signal {}: {}", number, draining_ ? "stopping at once" : "draining");
      if (draining_) return stop();
      begin_drain();
      wait_for_signal();
    });
  }

  void begin_drain() {
    if (draining_) return;
    draining_ = true;
    for (const auto& listener : listeners_) listener->stop();
    grace_.expires_after(options_.drain_grace);
    grace_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      spdlog::warn("{} connections outlived the grace period and are cut", registry_.count());
      registry_.cut();
    });
    registry_.drain([this] { asio::post(control_, [this] { stop(); }); });
  }

  const ServerOptions options_;
  std::unique_ptr<MeshStore> store_;
  asio::io_context context_;
  asio::strand<asio::io_context::executor_type> control_;  // guards what follows
  asio::signal_set signals_;
  asio::steady_timer grace_;
  bool draining_ = false;
  SessionRegistry registry_;
  std::vector<std::shared_ptr<Listener>> listeners_;
};

Server::Server(const ServerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::open(const ServerOptions& options) try {
  std::signal(SIGPIPE, SIG_IGN);
  std::unique_ptr<Server> server(new Server(options));
  if (Status opened = server->impl_->open_store(); !opened) return opened.error();
  if (!options.http.empty()) {
    auto address = server->impl_->listen<HttpSession>(options.http, http_refusal());
    if (!address) return address.error();
    server->http_address_ = *address;
  }
  if (!options.tcp.empty()) {
    auto address = server->impl_->listen<TcpSession>(options.tcp, tcp_refusal());
    if (!address) return address.error();
    server->tcp_address_ = *address;
  }
  return server;
} catch (const boost::system::system_error& error) {  // Asio lacks descriptors of its own
  return Error{ErrorCode::out_of_resources, std::string("cannot start: ") + error.what()};
}

void Server::handle_signals() { impl_->handle_signals(); }
void Server::run() { impl_->run(); }
void Server::drain() { impl_->drain(); }
void Server::stop() { impl_->stop(); }

}  // namespace pmesh
