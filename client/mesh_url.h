// Where a mesh is fetched from, as the user spells it:
//   http://HOST[:PORT]/[PREFIX/]ID          a pmesh server, perhaps below a proxy's path
//   http://HOST[:PORT]/PATH.pmesh[?QUERY]   a PM file on any web server
//   tcp://HOST:PORT/ID                      a pmesh server's frame protocol
//   PATH                                    a PM file on this machine
// The scheme's case does not matter. HOST may be an IPv6 address in brackets. ID is as in
// protocol/mesh_id.h.
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

  /// "host:port", with brackets around an IPv6 address.
  std::string text() const;
};

struct HttpMesh {
  Endpoint endpoint;
  std::string prefix;  ///< "" or "/path": what stands before the server's own routes.
  std::string id;
};

struct HttpFile {
  Endpoint endpoint;
  std::string target;  ///< Path and query, from the first '/' on.
};

struct TcpMesh {
  Endpoint endpoint;
  std::string id;
};

struct LocalFile {
  std::string path;
};

using MeshUrl = std::variant<HttpMesh, HttpFile, TcpMesh, LocalFile>;

/// Errors (usage) say what is wrong with the URL.
Result<MeshUrl> parse_mesh_url(std::string_view text);

}  // namespace pmesh
