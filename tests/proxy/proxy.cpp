#include "tests/proxy/proxy.h"

#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <nlohmann/json.hpp>

#include "tests/proxy/session.h"

namespace pmesh::test {

namespace asio = boost::asio;
using asio::ip::tcp;

std::string to_json(const ProxyCounts& counts) {
  const nlohmann::ordered_json json = {
      {"connections", counts.connections},   {"resets", counts.resets},
      {"short_bodies", counts.short_bodies}, {"dropped_ranges", counts.dropped_ranges},
      {"bad_gateways", counts.bad_gateways}, {"stalls", counts.stalls},
      {"bytes_down", counts.bytes_down},     {"bytes_up", counts.bytes_up},
      {"disconnects", counts.disconnects()}};
  return json.dump();
}

class SeededProxy::Impl {
 public:
  explicit Impl(const ProxyOptions& options)
      : options_(options), acceptor_(context_, {asio::ip::address_v4::loopback(), options.port}) {
    accept();
    thread_ = std::thread([this] { context_.run(); });
  }

  ~Impl() {
    context_.stop();
    thread_.join();
  }

  std::uint16_t port() const { return port_; }
  const SharedCounts& counts() const { return counts_; }

 private:
  void accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket client) {
      if (error == asio::error::operation_aborted) return;
      if (!error) {
        const std::uint64_t number = counts_.get().connections;
        counts_.add(&ProxyCounts::connections);
        std::make_shared<ProxySession>(std::move(client), options_, number, counts_)->start();
      }
      accept();
    });
  }

  ProxyOptions options_;
  SharedCounts counts_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  std::uint16_t port_ = acceptor_.local_endpoint().port();
  std::thread thread_;
};

SeededProxy::SeededProxy(const ProxyOptions& options) : impl_(std::make_unique<Impl>(options)) {}
SeededProxy::~SeededProxy() = default;

std::uint16_t SeededProxy::port() const { return impl_->port(); }
ProxyCounts SeededProxy::counts() const { return impl_->counts().get(); }

}  // namespace pmesh::test
