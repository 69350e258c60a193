// The proxy between a plain client and a plain server on the loopback.
#include "tests/proxy/proxy.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "tests/client/loopback.h"
#include "tests/proxy/random.h"

namespace pmesh::test {
namespace {

Bytes noise(std::size_t count) {
  Bytes bytes(count);
  Random random(1, 1);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
  return bytes;
}

// All that comes until the connection ends; `error` is errno if that was no clean end.
struct Received {
  Bytes bytes;
  int error = 0;
};

Received receive_all(const Peer& peer) {
  Received received;
  Bytes block(64 * 1024);
  for (;;) {
    const ssize_t count = ::recv(peer.descriptor(), block.data(), block.size(), 0);
    if (count < 0) received.error = errno;
    if (count <= 0) return received;
    received.bytes.insert(received.bytes.end(), block.begin(), block.begin() + count);
  }
}

// Sends back everything that it gets.
void echo(Peer& peer) {
  for (Bytes bytes = peer.receive(); !bytes.empty(); bytes = peer.receive()) peer.send(bytes);
}

Received echoed(std::uint16_t port, const Bytes& bytes) {
  Peer client(connect_to(port));
  std::thread sender([&] {
    client.send(bytes);
    ::shutdown(client.descriptor(), SHUT_WR);
  });
  Received received = receive_all(client);
  sender.join();
  return received;
}

TEST(SeededProxy, PassesBytesUnchangedBothWays) {
  LoopbackServer server(echo);
  SeededProxy proxy({.upstream_port = server.port()});
  const Bytes bytes = noise(3'000'000);
  const Received received = echoed(proxy.port(), bytes);
  EXPECT_EQ(received.error, 0);
  EXPECT_EQ(received.bytes, bytes);
  EXPECT_EQ(proxy.counts().bytes_up, bytes.size());
  EXPECT_EQ(proxy.counts().bytes_down, bytes.size());
  EXPECT_EQ(proxy.counts().disconnects(), 0u);
}

TEST(SeededProxy, KeepsTheOrderOfASlowLateAndStallingLink) {
  LoopbackServer server(echo);
  SeededProxy proxy({.upstream_port = server.port(),
                     .link = {.bits_per_second_down = 100'000'000,
                              .bits_per_second_up = 100'000'000,
                              .delay = std::chrono::milliseconds(5),
                              .segment_bytes = 1400,
                              .stall_probability = 0.05,
                              .stall = std::chrono::milliseconds(3)}});
  const Bytes bytes = noise(200'000);
  EXPECT_EQ(echoed(proxy.port(), bytes).bytes, bytes);
  EXPECT_GT(proxy.counts().stalls, 0u);
}

TEST(SeededProxy, IsNoFasterThanItsRate) {
  LoopbackServer server(echo);
  SeededProxy proxy({.upstream_port = server.port(), .link = {.bits_per_second_down = 16'000'000}});
  const auto start = std::chrono::steady_clock::now();
  echoed(proxy.port(), noise(1'000'000));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(450));
}

TEST(SeededProxy, ResetsConnectionsAtTheSamePlacesForTheSameSeed) {
  LoopbackServer server([](Peer& peer) {
    peer.send(noise(60'000));
    peer.receive();
  });
  const auto lengths = [&](std::uint64_t seed) {
    SeededProxy proxy({.upstream_port = server.port(),
                       .seed = seed,
                       .reset_probability = 1,
                       .reset_bytes = 50'000});
    std::vector<std::size_t> all;
    for (int i = 0; i < 5; ++i) {
      const Received received = receive_all(Peer(connect_to(proxy.port())));
      EXPECT_EQ(received.error, ECONNRESET);
      all.push_back(received.bytes.size());
    }
    EXPECT_EQ(proxy.counts().resets, 5u);
    return all;
  };
  const std::vector<std::size_t> first = lengths(1);
  EXPECT_EQ(lengths(1), first);
  EXPECT_NE(lengths(2), first);
  EXPECT_LE(*std::ranges::max_element(first), 50'000u);
}

// A web host with one file, and one exchange with it through a proxy.
class HttpProxy : public testing::Test {
 protected:
  Received get(ProxyOptions options, const std::string& extra = "") {
    options.upstream_port = host_port();
    options.is_http = true;
    proxy_.emplace(options);
    Peer client(connect_to(proxy_->port()));
    client.send(
        as_bytes("GET /mesh.pmesh HTTP/1.1\r\nHost: x\r\nConnection: close\r\n" + extra + "\r\n"));
    return receive_all(client);
  }
  std::uint16_t host_port() const {
    const std::string url = host_.url();
    return static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  }
  static std::string head_of(const Received& received) {
    const std::string text(received.bytes.begin(), received.bytes.end());
    return text.substr(0, text.find("\r\n\r\n") + 4);
  }
  static Bytes body_of(const Received& received) {
    const auto head = static_cast<std::ptrdiff_t>(head_of(received).size());
    return {received.bytes.begin() + head, received.bytes.end()};
  }

  Bytes file_ = noise(300'000);
  HttpHost host_{file_, {.keeps_alive = false}};
  std::optional<SeededProxy> proxy_;
};

TEST_F(HttpProxy, PassesRequestsAndAnswers) {
  const Received received = get({}, "Range: bytes=10-19\r\n");
  EXPECT_TRUE(head_of(received).starts_with("HTTP/1.1 206"));
  EXPECT_EQ(body_of(received), Bytes(file_.begin() + 10, file_.begin() + 20));
  EXPECT_EQ(host_.ranges(), std::vector<std::string>{"bytes=10-19"});
}

TEST_F(HttpProxy, DropsARange) {
  const Received received = get({.drop_range_probability = 1}, "Range: bytes=10-19\r\n");
  EXPECT_TRUE(head_of(received).starts_with("HTTP/1.1 200"));
  EXPECT_EQ(body_of(received), file_);
  EXPECT_EQ(proxy_->counts().dropped_ranges, 1u);
}

TEST_F(HttpProxy, CutsABodyByACleanEnd) {
  const Received received = get({.short_body_probability = 1, .short_bytes = 100'000});
  const Bytes body = body_of(received);
  EXPECT_EQ(received.error, 0);
  EXPECT_NE(head_of(received).find("Content-Length: 300000"), std::string::npos);
  EXPECT_LT(body.size(), 100'000u);
  EXPECT_TRUE(std::equal(body.begin(), body.end(), file_.begin()));
  EXPECT_EQ(proxy_->counts().disconnects(), 1u);
}

TEST_F(HttpProxy, AnswersForTheUpstream) {
  const Received received = get({.bad_gateway_probability = 1});
  EXPECT_TRUE(head_of(received).starts_with("HTTP/1.1 502"));
  EXPECT_TRUE(host_.ranges().empty());
  EXPECT_EQ(proxy_->counts().bad_gateways, 1u);
}

TEST(SeededProxy, PassesBytesOnlyAfterASwitchOfProtocols) {
  LoopbackServer server([](Peer& peer) {
    peer.receive();
    peer.send(as_bytes("HTTP/1.1 101 Switching Protocols\r\n\r\nfirst"));
    echo(peer);
  });
  SeededProxy proxy({.upstream_port = server.port(),
                     .is_http = true,
                     .short_body_probability = 1,
                     .bad_gateway_probability = 0});
  const std::string request = "GET / HTTP/1.1\r\nHost: x\r\n\r\n";
  Peer client(connect_to(proxy.port()));
  client.send(as_bytes(request));
  client.receive();
  client.send(as_bytes("GET no request"));
  ::shutdown(client.descriptor(), SHUT_WR);
  const Received received = receive_all(client);
  EXPECT_EQ(std::string(received.bytes.begin(), received.bytes.end()).find("HTTP"),
            std::string::npos);
  EXPECT_TRUE(
      std::string(received.bytes.begin(), received.bytes.end()).ends_with("GET no request"));
}

TEST(SeededProxy, TellsItsCountsAsJson) {
  const ProxyCounts counts{.connections = 4, .resets = 2, .short_bodies = 1};
  const auto json = nlohmann::json::parse(to_json(counts));
  EXPECT_EQ(json["connections"], 4);
  EXPECT_EQ(json["disconnects"], 3);
}

}  // namespace
}  // namespace pmesh::test
