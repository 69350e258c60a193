// The names of meshes. An id is the path of a PM file under the served directory without its
// ".pmesh", '/' written as '~': "scans/bunny.pmesh" has the id "scans~bunny". Every segment is
// one or more of [A-Za-z0-9._-] and does not begin with a dot, so an id can neither leave the
// directory nor name a hidden file; names that routes of the server use are reserved.
//
// Threads: pure functions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pmesh {

inline constexpr std::string_view kMeshFileSuffix = ".pmesh";
inline constexpr std::size_t kMaxMeshIdBytes = 512;

/// True if `id` may name a mesh: at most kMaxMeshIdBytes, good segments, not reserved.
bool is_mesh_id(std::string_view id);

/// The id of the file at `path`, relative to the served directory and with '/' between its
/// segments; nothing if the path does not end in ".pmesh" or gives no valid id.
std::optional<std::string> mesh_id_of_path(std::string_view path);

/// The relative path of the mesh `id`, the inverse of mesh_id_of_path. Precondition: is_mesh_id.
std::string path_of_mesh_id(std::string_view id);

}  // namespace pmesh
