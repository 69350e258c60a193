// Where a mesh is fetched from, as the user spells it:
//   http://HOST[:PORT]/[PREFIX/]ID[?QUERY]   a pmesh server, perhaps below a proxy's path
//   ws://HOST[:PORT]/[PREFIX/]ID[?QUERY]     the same server's frames over WebSocket
//   http://HOST[:PORT]/PATH.pmesh[?QUERY]    a PM file on any web server
//   tcp://HOST:PORT/ID[?QUERY]               a pmesh server's frame protocol
//   PATH                                     a PM file on this machine
// and https://, wss:// and tcps:// for the same with TLS. The scheme's case does not matter. HOST
// may be an IPv6 address in brackets. ID is as in protocol/mesh_id.h. The QUERY of a mesh is what
// lets one in (a signed URL's, as a rule); it is sent with every request and may hold no wish.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/result.h"

namespace pmesh {

struct Endpoint {
  std::string host;  ///< A name or address, without brackets.
  std::uint16_t port = 0;
  bool is_secure = false;  ///< By TLS.

  /// "host:port", with brackets around an IPv6 address.
  std::string text() const;
};

struct HttpMesh {
  Endpoint endpoint;
  std::string prefix;  ///< "" or "/path": what stands before the server's own routes.
  std::string id;
  std::string query;  ///< Without the '?'; may be empty.
};

/// Fetched by HTTP where the server, or what stands before it, knows no WebSocket.
struct WebSocketMesh {
  HttpMesh mesh;
};

struct HttpFile {
  Endpoint endpoint;
  std::string target;  ///< Path and query, from the first '/' on.
};

struct TcpMesh {
  Endpoint endpoint;
  std::string id;
  std::string query;  ///< Without the '?'; may be empty.
};

struct LocalFile {
  std::string path;
};

using MeshUrl = std::variant<HttpMesh, WebSocketMesh, HttpFile, TcpMesh, LocalFile>;

/// Errors (usage) say what is wrong with the URL.
Result<MeshUrl> parse_mesh_url(std::string_view text);

}  // namespace pmesh
