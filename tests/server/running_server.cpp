#include "tests/server/running_server.h"

#include <algorithm>
#include <cerrno>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace pmesh::testing {
namespace {

constexpr timeval kPatience{.tv_sec = 10, .tv_usec = 0};

sockaddr_in loopback(const std::string& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  result.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return result;
}

}  // namespace

RunningServer::RunningServer(const std::function<void(ServerOptions&)>& adjust) {
  ServerOptions options;
  options.directory = directory_ / "";
  options.http = options.tcp = "127.0.0.1:0";
  options.threads = 2;
  if (adjust) adjust(options);
  server_ = Server::open(options).value();
  thread_ = std::thread([this] { server_->run(); });
}

RunningServer::~RunningServer() {
  server_->stop();
  if (thread_.joinable()) thread_.join();
}

TestClient::TestClient(const std::string& address, int receive_buffer_bytes)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  if (receive_buffer_bytes > 0) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof(int));
  }
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
  const sockaddr_in to = loopback(address);
  EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
}

TestClient::~TestClient() { ::close(socket_); }

void TestClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

std::string TestClient::receive_some() {
  std::string bytes(65536, '\0');
  const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
  if (count < 0) {
    was_reset_ = errno == ECONNRESET;
    EXPECT_TRUE(was_reset_) << "nothing came";
  }
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return bytes;
}

std::string TestClient::receive(std::size_t count) {
  while (held_.size() < count) {
    const std::string more = receive_some();
    if (more.empty()) break;
    held_ += more;
  }
  const std::string taken = held_.substr(0, count);
  held_.erase(0, taken.size());
  return taken;
}

std::string TestClient::receive_until(std::string_view end) {
  std::size_t found = held_.find(end);
  while (found == std::string::npos) {
    const std::string more = receive_some();
    if (more.empty()) return std::exchange(held_, {});
    held_ += more;
    found = held_.find(end);
  }
  return receive(found + end.size());
}

std::string TestClient::receive_all() {
  for (std::string more = receive_some(); !more.empty(); more = receive_some()) held_ += more;
  return std::exchange(held_, {});
}

void TestClient::wait_for_end() {
  pollfd waiting{.fd = socket_, .events = 0, .revents = 0};
  EXPECT_EQ(::poll(&waiting, 1, 1000 * static_cast<int>(kPatience.tv_sec)), 1);
}

std::string HttpResponse::field(const std::string& name) const {
  const std::string start = "\r\n" + name + ": ";
  const std::size_t found = head.find(start);
  if (found == std::string::npos) return "";
  const std::size_t value = found + start.size();
  return head.substr(value, head.find("\r\n", value) - value);
}

HttpResponse read_response(TestClient& client, bool has_body) {
  HttpResponse response;
  response.head = client.receive_until("\r\n\r\n");
  if (!response.head.ends_with("\r\n\r\n")) return response;
  response.status = std::stoi(response.head.substr(9, 3));
  const std::string length = response.field("Content-Length");
  if (has_body && !length.empty()) response.body = client.receive(std::stoul(length));
  return response;
}

HttpResponse fetch(const std::string& address, const std::string& target,
                   const std::string& fields) {
  TestClient client(address);
  client.send(get_request(target, fields));
  return read_response(client);
}

std::string get_request(const std::string& target, const std::string& fields) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

}  // namespace pmesh::testing
