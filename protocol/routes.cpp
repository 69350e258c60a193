#include "protocol/routes.h"

#include <algorithm>
#include <vector>

#include "core/base/parse_number.h"
#include "protocol/letters.h"
#include "protocol/mesh_id.h"

namespace pmesh {
namespace {

/// -1 unless `c` is a hex digit.
int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// Cuts "http://host" off an absolute target; an empty path is "/".
std::string_view origin_form(std::string_view target) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!begins_in_any_case(target, scheme)) continue;
    const std::size_t path = target.find_first_of("/?", scheme.size());
    return path == std::string_view::npos ? std::string_view("/") : target.substr(path);
  }
  return target;
}

/// The decoded segments of "/a/b/c"; more than four are cut to five. Fails on a broken escape.
Result<std::vector<std::string>> path_segments(std::string_view path) {
  constexpr std::size_t kMostSegments = 5;
  std::vector<std::string> segments;
  segments.reserve(kMostSegments);
  while (!path.empty() && segments.size() < kMostSegments) {
    path.remove_prefix(1);  // the '/'
    const std::string_view segment = path.substr(0, path.find('/'));
    auto decoded = percent_decoded(segment);
    if (!decoded) return usage_error("the path has a broken percent escape");
    segments.push_back(std::move(*decoded));
    path.remove_prefix(segment.size());
  }
  return segments;
}

std::optional<ContentHash> file_hash(std::string_view name) {
  if (!name.ends_with(kMeshFileSuffix)) return {};
  return parse_hash(name.substr(0, name.size() - kMeshFileSuffix.size()));
}

/// percent_decoded, but a '%' at the very end, where no escape can begin, stands for itself.
std::optional<std::string> decoded_query(std::string_view query) {
  const bool ends_in_percent = query.ends_with('%');
  if (ends_in_percent) query.remove_suffix(1);
  auto decoded = percent_decoded(query);
  if (decoded && ends_in_percent) decoded->push_back('%');
  return decoded;
}

/// The inverse for a wish, whose one character that needs an escape is the '%' at its end.
std::string escaped_query(const LodRequest& wish) {
  std::string query = to_query(wish);
  if (query.ends_with('%')) query.append("25");
  return query;
}

Result<Route> file_route(const std::string& id, const ContentHash& hash, std::string_view query) {
  const auto decoded = decoded_query(query);
  if (!decoded) return usage_error("the query has a broken percent escape");
  auto wish = parse_wish(*decoded);
  if (!wish) return wish.error();
  return Route(MeshFileRoute{id, hash, *wish});
}

/// Takes "draco=0" or "draco=1" out of a query of "&"-separated members; what is left is the wish.
Result<bool> take_draco(std::string& query) {
  constexpr std::string_view kKey = "draco=";
  std::size_t begin = 0;
  while (begin < query.size()) {
    const std::size_t end = std::min(query.find('&', begin), query.size());
    const std::string_view member = std::string_view(query).substr(begin, end - begin);
    if (!member.starts_with(kKey)) {
      begin = end + 1;
      continue;
    }
    const std::string value(member.substr(kKey.size()));
    if (value != "0" && value != "1") return usage_error("draco: expected 0 or 1");
    const bool is_last = end == query.size();
    query.erase(is_last && begin > 0 ? begin - 1 : begin,
                member.size() + (is_last ? begin > 0 : 1));
    return value == "1";
  }
  return false;
}

/// "lod.glb" and the like; nothing if `name` is none.
std::optional<std::string_view> lod_ending(std::string_view name) {
  constexpr std::string_view kStem = "lod.";
  if (!name.starts_with(kStem) || !lod_format_of(name.substr(kStem.size()))) return {};
  return name.substr(kStem.size());
}

Result<Route> lod_route(const std::string& id, std::string_view ending, std::string_view query) {
  auto decoded = decoded_query(query);
  if (!decoded) return usage_error("the query has a broken percent escape");
  const auto draco = take_draco(*decoded);
  if (!draco) return draco.error();
  auto wish = parse_wish(*decoded);
  if (!wish) return wish.error();
  return Route(LodRoute{id, *lod_format_of(ending, *draco), *wish});
}

Result<Route> mesh_route(const std::vector<std::string>& segments, std::string_view query) {
  const std::string& id = segments.front();
  if (segments.size() == 1) return Route(MeshInfoRoute{id});
  if (segments.size() == 2) {
    const auto hash = file_hash(segments[1]);
    if (hash) return file_route(id, *hash, query);
    if (const auto ending = lod_ending(segments[1])) return lod_route(id, *ending, query);
    if (segments[1] == "stream") return Route(StreamRoute{id});
  }
  if (segments.size() == 4 && segments[2] == "c") {
    const auto hash = parse_hash(segments[1]);
    const auto chunk = parse_whole<std::uint64_t>(segments[3]);
    if (hash && chunk) return Route(ChunkRoute{id, *hash, *chunk});
  }
  return Route(UnknownRoute{});
}

}  // namespace

Result<Route> parse_target(std::string_view target) {
  target = origin_form(target);
  if (!target.starts_with('/')) return usage_error("the request target is not a path");
  const std::size_t question = target.find('?');
  const std::string_view path = target.substr(0, question);
  const std::string_view query =
      question == std::string_view::npos ? std::string_view() : target.substr(question + 1);

  const auto segments = path_segments(path);
  if (!segments) return segments.error();
  const std::string& first = segments->front();
  if (segments->size() == 1) {
    if (first.empty()) return Route(ViewerRoute{});
    if (first == "catalog") return Route(CatalogRoute{});
    if (first == "health") return Route(HealthRoute{});
    if (first == "metrics") return Route(MetricsRoute{});
    if (first == "openapi.json") return Route(OpenapiRoute{});
  }
  if (segments->size() == 2 && first == "view" && is_mesh_id((*segments)[1])) {
    return Route(ViewerRoute{(*segments)[1]});
  }
  if (!is_mesh_id(first)) return Route(UnknownRoute{});
  return mesh_route(*segments, query);
}

std::string file_target(std::string_view id, const ContentHash& hash, const LodRequest& wish) {
  std::string target = "/";
  target.append(id).append("/").append(to_hex(hash)).append(kMeshFileSuffix);
  const std::string query = escaped_query(wish);
  if (!query.empty()) target.append("?").append(query);
  return target;
}

std::string chunk_target(std::string_view id, const ContentHash& hash, std::uint64_t chunk) {
  std::string target = "/";
  target.append(id).append("/").append(to_hex(hash)).append("/c/").append(std::to_string(chunk));
  return target;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  if (text.find('%') == std::string_view::npos) return std::string(text);
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    if (text.size() - i < 3) return {};
    const int high = hex_value(text[i + 1]), low = hex_value(text[i + 2]);
    if (high < 0 || low < 0) return {};
    decoded.push_back(static_cast<char>(16 * high + low));
    i += 2;
  }
  return decoded;
}

std::optional<ContentHash> parse_hash(std::string_view hex) {
  ContentHash hash;
  if (hex.size() != 2 * hash.size()) return {};
  if (hex.find_first_not_of("0123456789abcdef") != std::string_view::npos) return {};
  for (std::size_t i = 0; i < hash.size(); ++i) {
    hash[i] = static_cast<std::uint8_t>(16 * hex_value(hex[2 * i]) + hex_value(hex[2 * i + 1]));
  }
  return hash;
}

}  // namespace pmesh
