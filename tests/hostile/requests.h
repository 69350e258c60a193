// Requests that nobody honest sends, made by combination: what the server, and the proxies in front
// of it, are tried with.
#pragma once

#include <string>
#include <vector>

namespace pmesh::testing {

struct HostileRequest {
  std::string name;   ///< What is odd about it.
  std::string bytes;  ///< Of the whole connection.
};

/// The target of the request that is hidden in each smuggling variant, a mesh of that id.
inline constexpr const char* kHiddenId = "hidden";

/// Requests about whose end two readers could differ, each followed by another request (for
/// /hidden) where some reader would look for it. More than 200. A strict server refuses all.
std::vector<HostileRequest> smuggling_requests();

/// Requests that are odd but have one meaning, each with Connection: close.
std::vector<HostileRequest> odd_requests();

/// Targets that lead out of the served directory for a reader who decodes once too often. They aim
/// at the file or mesh `secret` beside the served directory. More than 200.
std::vector<std::string> traversal_targets();

}  // namespace pmesh::testing
