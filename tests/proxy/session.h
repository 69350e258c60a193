// One connection of the proxy: a client, its upstream, and a pipe each way.
//
// Threads: belongs to the thread of its proxy.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>

#include "tests/proxy/pipe.h"
#include "tests/proxy/proxy.h"
#include "tests/proxy/random.h"
#include "tests/proxy/shared_counts.h"

namespace pmesh::test {

class ProxySession : public std::enable_shared_from_this<ProxySession> {
 public:
  using Socket = boost::asio::ip::tcp::socket;

  /// Connection `number` of the proxy. The options and counts must outlive it.
  ProxySession(Socket client, const ProxyOptions& options, std::uint64_t number,
               SharedCounts& counts);

  /// Runs in the background until both sides are done.
  void start();

 private:
  /// What is to befall one HTTP exchange.
  struct Fate {
    bool is_bad_gateway = false;
    bool is_range_dropped = false;
    bool is_short = false;
    std::uint64_t cut = 0;  // where a short body ends
  };

  boost::asio::awaitable<void> run();
  boost::asio::awaitable<void> deliver(Pipe& pipe);
  boost::asio::awaitable<void> pump(Socket& from, Pipe& pipe);
  boost::asio::awaitable<void> exchange_http();
  boost::asio::awaitable<bool> pass_request(Fate& fate);
  boost::asio::awaitable<bool> pass_response(const Fate& fate);
  boost::asio::awaitable<bool> pass_body(std::uint64_t length, const Fate& fate);
  boost::asio::awaitable<bool> pass_unread(boost::beast::flat_buffer& unread, Pipe& pipe,
                                           std::uint64_t most);
  boost::asio::awaitable<void> pass_all();
  Fate roll();
  void reset();
  void close();

  const ProxyOptions& options_;
  SharedCounts& counts_;
  Random random_;
  Socket client_;
  Socket upstream_;
  Pipe down_;
  Pipe up_;
  boost::beast::flat_buffer from_client_;
  boost::beast::flat_buffer from_upstream_;
  // Of the request under way.
  bool is_head_request_ = false;
  bool is_last_request_ = false;
};

}  // namespace pmesh::test
