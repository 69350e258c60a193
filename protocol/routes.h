// The HTTP routes: a request's target as a typed route (docs/protocol.md, section 2).
//
// Threads: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/base/result.h"
#include "core/pm/format.h"
#include "protocol/lod_format.h"
#include "protocol/lod_request.h"

namespace pmesh {

/// GET /catalog
struct CatalogRoute {
  friend bool operator==(const CatalogRoute&, const CatalogRoute&) = default;
};

/// GET /health
struct HealthRoute {
  friend bool operator==(const HealthRoute&, const HealthRoute&) = default;
};

/// GET /{id}
struct MeshInfoRoute {
  std::string id;
  friend bool operator==(const MeshInfoRoute&, const MeshInfoRoute&) = default;
};

/// GET /{id}/{hash}.pmesh[?wish]
struct MeshFileRoute {
  std::string id;
  ContentHash hash{};
  LodRequest wish;  ///< Everything if the target has no query.
  friend bool operator==(const MeshFileRoute&, const MeshFileRoute&) = default;
};

/// GET /{id}/{hash}/c/{chunk}
struct ChunkRoute {
  std::string id;
  ContentHash hash{};
  std::uint64_t chunk = 0;
  friend bool operator==(const ChunkRoute&, const ChunkRoute&) = default;
};

/// GET /{id}/lod.{glb,ply,obj,drc}[?wish[&draco=1]]
struct LodRoute {
  std::string id;
  LodFormat format{};
  LodRequest wish;
  friend bool operator==(const LodRoute&, const LodRoute&) = default;
};

/// GET /{id}/stream, to become a WebSocket
struct StreamRoute {
  std::string id;
  friend bool operator==(const StreamRoute&, const StreamRoute&) = default;
};

/// GET / and GET /view/{id}
struct ViewerRoute {
  std::string id;  ///< Empty: the list of all meshes.
  friend bool operator==(const ViewerRoute&, const ViewerRoute&) = default;
};

/// GET /metrics
struct MetricsRoute {
  friend bool operator==(const MetricsRoute&, const MetricsRoute&) = default;
};

/// GET /openapi.json
struct OpenapiRoute {
  friend bool operator==(const OpenapiRoute&, const OpenapiRoute&) = default;
};

/// Anything else that is well formed.
struct UnknownRoute {
  friend bool operator==(const UnknownRoute&, const UnknownRoute&) = default;
};

using Route =
    std::variant<UnknownRoute, CatalogRoute, HealthRoute, MeshInfoRoute, MeshFileRoute, ChunkRoute,
                 LodRoute, StreamRoute, ViewerRoute, MetricsRoute, OpenapiRoute>;

/// The route of a request target in origin form ("/bunny") or absolute form
/// ("http://host/bunny"). The path is split at '/' before its percent escapes are decoded, and
/// dot segments are not resolved: they are no ids. Fails (usage) on a broken escape, another form
/// of target or a bad wish: answer 400. A '%' that ends a query begins no escape and stands for
/// itself: "?error=1%" is "?error=1%25". Queries of routes that take no wish are ignored.
Result<Route> parse_target(std::string_view target);

/// "/{id}/{hash}.pmesh", with "?wish" (escaped as a query must be) unless it is for everything.
std::string file_target(std::string_view id, const ContentHash& hash, const LodRequest& wish = {});

/// "/{id}/{hash}/c/{chunk}".
std::string chunk_target(std::string_view id, const ContentHash& hash, std::uint64_t chunk);

/// `text` with its %XX escapes decoded; nothing if one is broken.
std::optional<std::string> percent_decoded(std::string_view text);

/// The inverse of to_hex: nothing unless `hex` is 32 lower-case hex digits.
std::optional<ContentHash> parse_hash(std::string_view hex);

}  // namespace pmesh
