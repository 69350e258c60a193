#include "server/server.h"

#include <csignal>
#include <vector>

#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/system/system_error.hpp>
#include <spdlog/spdlog.h>

#include "server/frames/tcp_session.h"
#include "server/http/http_session.h"
#include "server/metrics/prometheus.h"
#include "server/net/listener.h"
#include "server/net/reactors.h"
#include "server/net/refusal_session.h"
#include "server/services.h"

namespace pmesh {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

/// Of those who read the metrics on a port of their own.
constexpr std::size_t kMostMetricsConnections = 64;

/// Connections that are told why they are turned away, at a time.
constexpr std::size_t kMostRefusals = 256;

/// For sessions that were cut.
constexpr std::chrono::seconds kTimeToEnd{1};

}  // namespace

/// What a server is made of, in the order in which it must stand: sessions live in the reactors,
/// use what comes before them to their last breath, and ask for levels only while the reactors run;
/// workers hand what they make to the reactors.
class Server::Impl {
 public:
  Impl(const ServerOptions& options, std::unique_ptr<MeshStore> store, TrustedProxies proxies,
       PolicyPtr policy)
      : options_(options),
        store_(std::move(store)),
        catalogue_(*store_),
        addresses_(options.max_connections_per_address),
        proxies_(std::move(proxies)),
        policy_(std::move(policy)),
        services_(services(options.metrics.empty(), false)),
        metrics_services_(services(true, true)),
        reactors_(options.threads),
        lod_(options.lod),
        signals_(reactors_.first()),
        grace_(reactors_.first()),
        registry_(options.max_connections),
        metrics_registry_(kMostMetricsConnections),
        refusals_(kMostRefusals) {}

  template <class SessionType>
  Result<std::string> listen(const std::string& address, WireProtocol protocol) {
    return listen<SessionType>(address, protocol, services_, registry_);
  }
  Result<std::string> listen_for_metrics() {
    return listen<HttpSession>(options_.metrics, WireProtocol::http, metrics_services_,
                               metrics_registry_);
  }

  void handle_signals(Reload reload) {
    reload_ = std::move(reload);
    signals_.add(SIGTERM);
    signals_.add(SIGINT);
    if (reload_) signals_.add(SIGHUP);
    wait_for_signal();
  }

  void run() {
    for (const auto& listener : listeners_) listener->start();
    reactors_.run();
  }

  void drain() {
    asio::post(reactors_.first(), [this] { begin_drain(); });
  }

  void stop() { reactors_.stop(); }

  Status reload(const ServerOptions& options) {
    const auto policy = make_policy(options);
    metrics_.reloads.add(policy ? ReloadResult::done : ReloadResult::failed);
    if (!policy) return policy.error();
    policy_.set(*policy);
    return {};
  }

 private:
  Services services(bool with_metrics, bool only_operation) {
    std::function<std::string()> metrics_text;
    if (with_metrics) metrics_text = [this] { return this->metrics_text(); };
    return {*store_,       catalogue_,         lod_,
            metrics_,      addresses_,         proxies_,
            policy_,       options_.lod.faces, std::move(metrics_text),
            only_operation};
  }

  std::string metrics_text() {
    return prometheus_text(metrics_, lod_.statistics(), store_->list().size());
  }

  template <class SessionType>
  Result<std::string> listen(const std::string& address, WireProtocol protocol, Services& services,
                             SessionRegistry& registry) {
    const auto make_session = [&services](Socket& socket) -> std::shared_ptr<Session> {
      boost::system::error_code ignored;
      const asio::ip::address peer = unmapped(socket.remote_endpoint(ignored).address());
      std::optional<AddressCounts::Slot> slot = AddressCounts::Slot();
      if (!services.proxies.contains(peer)) slot = services.addresses.enter(peer);
      if (slot) {
        return std::make_shared<SessionType>(std::move(socket), services, std::move(*slot));
      }
      services.metrics.limits.add(LimitName::connections_per_address);
      return nullptr;
    };
    const auto make_refusal = [&services, &registry, protocol](Socket& socket) {
      if (registry.full()) services.metrics.limits.add(LimitName::connections);
      return std::make_shared<RefusalSession>(std::move(socket), services, protocol,
                                              SessionType::refusal_text());
    };
    auto listener =
        Listener::bind(reactors_, address, {registry, make_session}, {refusals_, make_refusal});
    if (!listener) return listener.error();
    listeners_.push_back(*listener);
    return (*listener)->address();
  }

  void wait_for_signal() {
    signals_.async_wait([this](const boost::system::error_code& error, int number) {
      if (error) return;
      if (number == SIGHUP) {
        reload_now();
      } else {
        spdlog::info("signal {}: {}", number, draining_ ? "stopping at once" : "draining");
        if (draining_) return stop();
        begin_drain();
      }
      wait_for_signal();
    });
  }

  void reload_now() {
    const auto options = reload_();
    if (!options) metrics_.reloads.add(ReloadResult::failed);
    const Status reloaded = options ? reload(*options) : Status(options.error());
    if (reloaded) {
      spdlog::info("reloaded");
    } else {
      spdlog::error("not reloaded: {}", reloaded.error().message);
    }
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
      grace_.expires_after(kTimeToEnd);
      grace_.async_wait([this](const boost::system::error_code& stopped) {
        if (!stopped) stop();  // some wait for a level of detail, which is no reason to
      });
    });
    metrics_registry_.drain([] {});
    registry_.drain([this] { asio::post(reactors_.first(), [this] { stop(); }); });
  }

  const ServerOptions options_;
  const std::unique_ptr<MeshStore> store_;
  CatalogueCache catalogue_;
  Metrics metrics_;
  AddressCounts addresses_;
  const TrustedProxies proxies_;
  CurrentPolicy policy_;
  Services services_;
  Services metrics_services_;
  Reactors reactors_;
  LodService lod_;

  // From here on used on the first reactor's thread alone, once it runs.
  asio::signal_set signals_;
  Timer grace_;
  Reload reload_;
  bool draining_ = false;
  SessionRegistry registry_;
  SessionRegistry metrics_registry_;
  SessionRegistry refusals_;
  std::vector<std::shared_ptr<Listener>> listeners_;
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::open(const ServerOptions& options) try {
  std::signal(SIGPIPE, SIG_IGN);
  auto store = MeshStore::open(options.directory);
  if (!store) return store.error();
  auto proxies = TrustedProxies::parse(options.trusted_proxies);
  if (!proxies) return proxies.error();
  auto policy = make_policy(options);
  if (!policy) return policy.error();
  std::unique_ptr<Server> server(
      new Server(std::make_unique<Impl>(options, std::move(*store), *proxies, *policy)));
  if (Status listening = server->listen(options); !listening) return listening.error();
  return server;
} catch (const boost::system::system_error& error) {  // Asio lacks descriptors of its own
  return Error{ErrorCode::out_of_resources, std::string("cannot start: ") + error.what()};
}

Status Server::listen(const ServerOptions& options) {
  if (!options.http.empty()) {
    auto address = impl_->listen<HttpSession>(options.http, WireProtocol::http);
    if (!address) return address.error();
    http_address_ = *address;
  }
  if (!options.tcp.empty()) {
    auto address = impl_->listen<TcpSession>(options.tcp, WireProtocol::frames);
    if (!address) return address.error();
    tcp_address_ = *address;
  }
  if (!options.metrics.empty()) {
    auto address = impl_->listen_for_metrics();
    if (!address) return address.error();
    metrics_address_ = *address;
  }
  return {};
}

void Server::handle_signals(Reload reload) { impl_->handle_signals(std::move(reload)); }
void Server::run() { impl_->run(); }
void Server::drain() { impl_->drain(); }
void Server::stop() { impl_->stop(); }
Status Server::reload(const ServerOptions& options) { return impl_->reload(options); }

}  // namespace pmesh
