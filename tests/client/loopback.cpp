#include "tests/client/loopback.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/pm/format.h"
#include "protocol/catalogue_json.h"
#include "protocol/routes.h"

namespace pmesh::test {
namespace {

// A peer silent for so long has hung: only tests that fail wait for it.
constexpr int kPatienceMilliseconds = 10'000;

// Nothing at all for the status 0.
std::string empty_response(int status, const std::string& fields) {
  if (status == 0) return "";
  return "HTTP/1.1 " + std::to_string(status) + " Status\r\n" + fields +
         "Content-Length: 0\r\n\r\n";
}

sockaddr_in loopback_address(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

}  // namespace

int connect_to(std::uint16_t port) {
  const sockaddr_in address = loopback_address(port);
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    std::abort();
  }
  return descriptor;
}

Peer::~Peer() { ::close(descriptor_); }

Bytes Peer::receive() {
  pollfd waiting{descriptor_, POLLIN, 0};
  if (::poll(&waiting, 1, kPatienceMilliseconds) != 1) return {};
  Bytes bytes(64 * 1024);
  const ssize_t count = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return bytes;
}

bool Peer::send(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

LoopbackServer::LoopbackServer(std::function<void(Peer&)> serve) : serve_(std::move(serve)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback_address(0);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, generic, size) != 0 || ::listen(listener_, 64) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    std::abort();
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

LoopbackServer::~LoopbackServer() {
  stopping_ = true;
  ::shutdown(listener_, SHUT_RDWR);
  thread_.join();
  ::close(listener_);
}

void LoopbackServer::run() {
  while (!stopping_) {
    const int accepted = ::accept(listener_, nullptr, nullptr);
    if (accepted < 0) continue;
    ++connections_;
    Peer peer(accepted);
    serve_(peer);
  }
}

void pass(Peer& client, std::uint16_t server_port, std::size_t allowed) {
  Peer server(connect_to(server_port));
  pollfd ends[] = {{client.descriptor(), POLLIN, 0}, {server.descriptor(), POLLIN, 0}};
  while (::poll(ends, 2, kPatienceMilliseconds) > 0) {
    if (ends[0].revents != 0) {
      const Bytes request = client.receive();
      if (request.empty() || !server.send(request)) return;
    }
    if (ends[1].revents != 0) {
      const Bytes answer = server.receive();
      const std::size_t count = std::min(allowed, answer.size());
      if (count == 0 || !client.send(ByteView(answer).first(count))) return;
      allowed -= count;
      if (allowed == 0) return;
    }
  }
}

HttpHost::HttpHost(Bytes file, HttpBehaviour behaviour)
    : behaviour_(std::move(behaviour)), server_([this](Peer& peer) { serve(peer); }) {
  put(std::move(file));
}

// All that is to be had of `file`; of what is no PM file, only the file itself.
void HttpHost::put(Bytes file) {
  files_.clear();
  if (const auto index = parse_prologue(file); index && *index) {
    const std::string json = mesh_info_json({"mesh", &**index});
    const ContentHash& hash = (*index)->header.content_hash;
    hashed_target_ = file_target("mesh", hash);
    files_["/mesh"] = Bytes(json.begin(), json.end());
    files_[hashed_target_] = file;
    std::uint64_t number = 0;
    for (const ChunkRow& chunk : (*index)->chunks) {
      const auto begin = file.begin() + static_cast<std::ptrdiff_t>(chunk.offset);
      if (chunk.end() > file.size() || !behaviour_.has_chunks) break;
      files_[chunk_target("mesh", hash, number++)] =
          Bytes(begin, begin + static_cast<std::ptrdiff_t>(chunk.bytes));
    }
  }
  files_["/mesh.pmesh"] = std::move(file);
}

std::string HttpHost::url(const std::string& target) const {
  return "http://127.0.0.1:" + std::to_string(port()) + target;
}

void HttpHost::serve(Peer& peer) {
  std::string request;
  for (Bytes bytes = peer.receive(); !bytes.empty(); bytes = peer.receive()) {
    request.append(bytes.begin(), bytes.end());
    if (request.find("\r\n\r\n") == std::string::npos) continue;
    if (!answer(peer, std::exchange(request, {})) || !behaviour_.keeps_alive) return;
  }
}

// False to close the connection.
bool HttpHost::answer(Peer& peer, const std::string& request) {
  const std::string response =
      behaviour_.raw_answer.empty() ? response_to(request) : behaviour_.raw_answer;
  if (behaviour_.stalls > 0) {
    --behaviour_.stalls;
    peer.send(as_bytes(response).first(response.size() / 2));
    return !peer.receive().empty();  // until the client has had enough
  }
  if (behaviour_.cut_after) {
    const std::size_t allowed = behaviour_.cut_after();
    if (allowed < response.size()) {
      peer.send(as_bytes(response).first(allowed));
      return false;
    }
  }
  const bool goes_on = !response.empty() && behaviour_.raw_answer.empty();
  return peer.send(as_bytes(response)) && goes_on;
}

std::string HttpHost::response_to(const std::string& request) {
  const std::size_t header = request.find("Range: ");
  const bool has_range = header != std::string::npos;
  requests_.push_back(request);
  ranges_.push_back(has_range ? request.substr(header + 7, request.find('\r', header) - header - 7)
                              : "");
  targets_.push_back(request.substr(4, request.find(' ', 4) - 4));
  const std::string target = targets_.back().substr(0, targets_.back().find('?'));
  if (target == hashed_target_ && behaviour_.requests_until_replaced > 0 &&
      --behaviour_.requests_until_replaced == 0) {
    put(behaviour_.replacement);
  }
  if (target == "/mesh/stream") return empty_response(behaviour_.upgrade_status, "");
  const auto file = files_.find(target);
  if (file == files_.end()) return empty_response(404, "");
  if (behaviour_.failures > 0) {
    --behaviour_.failures;
    return empty_response(503, behaviour_.extra_header);
  }
  return file_response(file->second, ranges_.back());
}

std::string HttpHost::file_response(const Bytes& file, const std::string& range) {
  unsigned long long first = 0;
  unsigned long long last = file.size() - 1;
  const bool is_ignored = behaviour_.ignored_ranges > 0 && !range.starts_with("bytes=0-");
  if (is_ignored) --behaviour_.ignored_ranges;
  std::string head = "HTTP/1.1 200 OK\r\n";
  if (!range.empty() && !behaviour_.ignores_ranges && !is_ignored) {
    std::sscanf(range.c_str(), "bytes=%llu-%llu", &first, &last);
    const std::string total = std::to_string(file.size());
    if (first >= file.size()) {
      return empty_response(416, "Content-Range: bytes */" + total + "\r\n");
    }
    last = std::min<unsigned long long>(last, file.size() - 1);
    head = "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes " + std::to_string(first) + "-" +
           std::to_string(last) + "/" + total + "\r\n";
  }
  head += behaviour_.extra_header;
  std::string body(file.begin() + static_cast<long>(first),
                   file.begin() + static_cast<long>(last) + 1);
  if (!behaviour_.chunked) {
    return head + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }
  char size[20];
  std::snprintf(size, sizeof size, "%zx\r\n", body.size());
  return head + "Transfer-Encoding: chunked\r\n\r\n" + size + body + "\r\n0\r\n\r\n";
}

}  // namespace pmesh::test
