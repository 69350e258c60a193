#include "client/mesh_url.h"

#include <algorithm>
#include <optional>

#include "core/base/parse_number.h"
#include "protocol/letters.h"
#include "protocol/mesh_id.h"

namespace pmesh {
namespace {

constexpr std::uint16_t kHttpPort = 80;

struct UrlParts {
  Endpoint endpoint;
  std::string_view target;  // from the first '/' on; may be empty
};

Error bad_url(std::string_view url, const std::string& why) {
  return {ErrorCode::usage, "URL \"" + std::string(url) + "\": " + why};
}

bool is_host_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '-' || c == '_';
}

// "host", "host:port", "[v6]" or "[v6]:port"; port 0 means that none was given.
std::optional<Endpoint> parse_authority(std::string_view text) {
  Endpoint endpoint;
  std::size_t host_end = 0;
  if (text.starts_with('[')) {
    const std::size_t bracket = text.find(']');
    if (bracket == std::string_view::npos) return {};
    endpoint.host = text.substr(1, bracket - 1);
    if (endpoint.host.find_first_not_of("0123456789abcdefABCDEF:.%") != std::string::npos)
      return {};
    host_end = bracket + 1;
  } else {
    host_end = std::min(text.find(':'), text.size());
    endpoint.host = text.substr(0, host_end);
    if (!std::ranges::all_of(endpoint.host, is_host_character)) return {};
  }
  if (endpoint.host.empty()) return {};
  const std::string_view rest = text.substr(host_end);
  if (rest.empty()) return endpoint;
  const auto port = parse_whole<std::uint16_t>(rest.substr(1));
  if (rest.front() != ':' || !port || *port == 0) return {};
  endpoint.port = *port;
  return endpoint;
}

Result<UrlParts> parse_parts(std::string_view url, std::uint16_t default_port) {
  const bool printable = std::ranges::all_of(url, [](char c) { return c > ' ' && c < 0x7F; });
  if (!printable) return bad_url(url, "a character that must be percent-encoded");
  std::string_view rest = url.substr(url.find("://") + 3);
  rest = rest.substr(0, rest.find('#'));
  const std::size_t slash = std::min(rest.find_first_of("/?"), rest.size());
  std::optional<Endpoint> endpoint = parse_authority(rest.substr(0, slash));
  if (!endpoint) return bad_url(url, "expected HOST or HOST:PORT after \"://\"");
  if (endpoint->port == 0) endpoint->port = default_port;
  if (endpoint->port == 0) return bad_url(url, "a port is needed, as in tcp://HOST:PORT/ID");
  return UrlParts{*endpoint, rest.substr(slash)};
}

Result<MeshUrl> parse_http(std::string_view url) {
  const Result<UrlParts> parts = parse_parts(url, kHttpPort);
  if (!parts) return parts.error();
  const std::string_view target = parts->target;
  const std::string_view path = target.substr(0, target.find('?'));
  if (path.ends_with(".pmesh")) return MeshUrl(HttpFile{parts->endpoint, std::string(target)});
  if (path.size() != target.size()) {
    return bad_url(url, "say the level of detail by an option, not in the URL");
  }
  const std::size_t slash = path.rfind('/');
  const std::string_view id = slash == std::string_view::npos ? "" : path.substr(slash + 1);
  if (!is_mesh_id(id)) return bad_url(url, "expected a mesh's id, or a path ending in .pmesh");
  return MeshUrl(HttpMesh{parts->endpoint, std::string(path.substr(0, slash)), std::string(id)});
}

Result<MeshUrl> parse_tcp(std::string_view url) {
  const Result<UrlParts> parts = parse_parts(url, 0);
  if (!parts) return parts.error();
  const std::string_view target = parts->target;
  const std::string_view id = target.starts_with('/') ? target.substr(1) : "";
  if (!is_mesh_id(id)) return bad_url(url, "expected a mesh's id, as in tcp://HOST:PORT/ID");
  return MeshUrl(TcpMesh{parts->endpoint, std::string(id)});
}

}  // namespace

std::string Endpoint::text() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Result<MeshUrl> parse_mesh_url(std::string_view text) {
  if (text.empty()) return Error{ErrorCode::usage, "the URL is empty"};
  if (text.find("://") == std::string_view::npos) return MeshUrl(LocalFile{std::string(text)});
  if (begins_in_any_case(text, "http://")) return parse_http(text);
  if (begins_in_any_case(text, "tcp://")) return parse_tcp(text);
  return bad_url(text, "expected http://, tcp:// or a path");
}

}  // namespace pmesh
