#include "client/mesh_url.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/base/parse_number.h"
#include "protocol/letters.h"
#include "protocol/mesh_id.h"

namespace pmesh {
namespace {

constexpr std::uint16_t kHttpPort = 80;
constexpr std::uint16_t kHttpsPort = 443;

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

Result<UrlParts> parse_parts(std::string_view url, bool is_secure, std::uint16_t default_port) {
  const bool printable = std::ranges::all_of(url, [](char c) { return c > ' ' && c < 0x7F; });
  if (!printable) return bad_url(url, "a character that must be percent-encoded");
  std::string_view rest = url.substr(url.find("://") + 3);
  rest = rest.substr(0, rest.find('#'));
  const std::size_t slash = std::min(rest.find_first_of("/?"), rest.size());
  std::optional<Endpoint> endpoint = parse_authority(rest.substr(0, slash));
  if (!endpoint) return bad_url(url, "expected HOST or HOST:PORT after \"://\"");
  if (endpoint->port == 0) endpoint->port = default_port;
  if (endpoint->port == 0) return bad_url(url, "a port is needed, as in tcp://HOST:PORT/ID");
  endpoint->is_secure = is_secure;
  return UrlParts{*endpoint, rest.substr(slash)};
}

bool has_wish(std::string_view query) {
  constexpr std::array<std::string_view, 6> kKeys = {
      "faces=", "vertices=", "ratio=", "error=", "bytes=", "chunks="};
  for (std::size_t begin = 0; begin < query.size();) {
    const std::size_t end = std::min(query.find('&', begin), query.size());
    const std::string_view parameter = query.substr(begin, end - begin);
    if (std::ranges::any_of(kKeys, [&](auto key) { return parameter.starts_with(key); })) {
      return true;
    }
    begin = end + 1;
  }
  return false;
}

Result<HttpMesh> parse_mesh(std::string_view url, const UrlParts& parts) {
  const std::size_t question = std::min(parts.target.find('?'), parts.target.size());
  const std::string_view path = parts.target.substr(0, question);
  const std::string_view query = parts.target.substr(std::min(question + 1, parts.target.size()));
  if (has_wish(query)) return bad_url(url, "say the level of detail by an option, not in the URL");
  const std::size_t slash = path.rfind('/');
  const std::string_view id = slash == std::string_view::npos ? "" : path.substr(slash + 1);
  if (!is_mesh_id(id))
    return bad_url(url, "expected a mesh's id, or (over HTTP) a path ending in .pmesh");
  return HttpMesh{parts.endpoint, std::string(path.substr(0, slash)), std::string(id),
                  std::string(query)};
}

Result<MeshUrl> parse_http(std::string_view url, bool is_secure) {
  const Result<UrlParts> parts = parse_parts(url, is_secure, is_secure ? kHttpsPort : kHttpPort);
  if (!parts) return parts.error();
  const std::string_view path = parts->target.substr(0, parts->target.find('?'));
  if (path.ends_with(kMeshFileSuffix)) {
    return MeshUrl(HttpFile{parts->endpoint, std::string(parts->target)});
  }
  const Result<HttpMesh> mesh = parse_mesh(url, *parts);
  return mesh ? Result<MeshUrl>(*mesh) : mesh.error();
}

Result<MeshUrl> parse_web_socket(std::string_view url, bool is_secure) {
  const Result<UrlParts> parts = parse_parts(url, is_secure, is_secure ? kHttpsPort : kHttpPort);
  if (!parts) return parts.error();
  const Result<HttpMesh> mesh = parse_mesh(url, *parts);
  return mesh ? Result<MeshUrl>(WebSocketMesh{*mesh}) : mesh.error();
}

Result<MeshUrl> parse_tcp(std::string_view url, bool is_secure) {
  const Result<UrlParts> parts = parse_parts(url, is_secure, 0);
  if (!parts) return parts.error();
  const Result<HttpMesh> mesh = parse_mesh(url, *parts);
  if (!mesh) return mesh.error();
  if (!mesh->prefix.empty()) return bad_url(url, "expected a mesh's id, as in tcp://HOST:PORT/ID");
  return MeshUrl(TcpMesh{mesh->endpoint, mesh->id, mesh->query});
}

struct Scheme {
  std::string_view text;
  bool is_secure;
  Result<MeshUrl> (*parse)(std::string_view url, bool is_secure);
};

constexpr Scheme kSchemes[] = {
    {"http://", false, parse_http},     {"https://", true, parse_http},
    {"ws://", false, parse_web_socket}, {"wss://", true, parse_web_socket},
    {"tcp://", false, parse_tcp},       {"tcps://", true, parse_tcp},
};

}  // namespace

std::string Endpoint::text() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Result<MeshUrl> parse_mesh_url(std::string_view text) {
  if (text.empty()) return Error{ErrorCode::usage, "the URL is empty"};
  if (text.find("://") == std::string_view::npos) return MeshUrl(LocalFile{std::string(text)});
  for (const auto& [scheme, is_secure, parse] : kSchemes) {
    if (begins_in_any_case(text, scheme)) return parse(text, is_secure);
  }
  return bad_url(text, "expected http[s]://, ws[s]://, tcp[s]:// or a path");
}

}  // namespace pmesh
