#include "protocol/mesh_id.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace pmesh {
namespace {

constexpr std::array<std::string_view, 6> kReserved = {"catalog", "health",       "metrics",
                                                       "view",    "openapi.json", "assets"};

bool is_segment_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

bool is_segment(std::string_view segment) {
  return !segment.empty() && segment.front() != '.' &&
         std::all_of(segment.begin(), segment.end(), is_segment_character);
}

std::string with_replaced(std::string_view text, char from, char to) {
  std::string replaced(text);
  std::replace(replaced.begin(), replaced.end(), from, to);
  return replaced;
}

}  // namespace

bool is_mesh_id(std::string_view id) {
  if (id.size() > kMaxMeshIdBytes) return false;
  if (std::find(kReserved.begin(), kReserved.end(), id) != kReserved.end()) return false;
  while (true) {
    const std::size_t tilde = id.find('~');
    if (!is_segment(id.substr(0, tilde))) return false;
    if (tilde == std::string_view::npos) return true;
    id.remove_prefix(tilde + 1);
  }
}

std::optional<std::string> mesh_id_of_path(std::string_view path) {
  if (!path.ends_with(kMeshFileSuffix) || path.find('~') != std::string_view::npos) return {};
  path.remove_suffix(kMeshFileSuffix.size());
  std::string id = with_replaced(path, '/', '~');
  if (!is_mesh_id(id)) return {};
  return id;
}

std::string path_of_mesh_id(std::string_view id) {
  assert(is_mesh_id(id));
  return with_replaced(id, '~', '/').append(kMeshFileSuffix);
}

}  // namespace pmesh
