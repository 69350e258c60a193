#include "server/http/http_answer.h"

#include <variant>

#include "protocol/catalogue_json.h"
#include "protocol/routes.h"
#include "server/http/conditions.h"
#include "server/http/openapi.h"
#include "server/http/viewer_page.h"
#include "server/metrics/prometheus.h"

namespace pmesh {
namespace {

constexpr std::string_view kMethods = "GET, HEAD, OPTIONS";

std::string quoted(std::string_view text) { return std::string("\"").append(text).append("\""); }

HttpAnswer text_answer(std::string_view type, std::string_view cache_control, std::string text) {
  HttpAnswer answer;
  answer.fields.add("Content-Type", type);
  answer.fields.add("Cache-Control", cache_control);
  answer.text = std::move(text);
  return answer;
}

HttpAnswer preflight() {
  HttpAnswer answer;
  answer.status = 204;
  answer.fields.add("Access-Control-Allow-Methods", kMethods);
  answer.fields.add("Access-Control-Allow-Headers",
                    "Range, If-Range, If-None-Match, Authorization");
  answer.fields.add("Access-Control-Max-Age", "86400");
  return answer;
}

HttpAnswer not_found(std::string_view what) { return error_answer(404, what); }

/// The answer if `found` is not a mesh.
HttpAnswer no_mesh(const Result<MeshPtr>& found, std::string_view not_found_text) {
  return found ? not_found(not_found_text) : busy_answer(503, "the mesh cannot be read now");
}

void add_level_fields(HeaderFields& fields, std::uint64_t faces, std::uint64_t vertices,
                      bool reached) {
  fields.add("PMesh-Faces", std::to_string(faces));
  fields.add("PMesh-Vertices", std::to_string(vertices));
  fields.add("PMesh-Reached", reached ? "1" : "0");
}

/// One tag for all wishes that come to the same bytes.
std::string level_etag(const MeshFile& mesh, const LodRequest& wish, const Resolution& level) {
  std::string tag = mesh.hash_text();
  if (wish.kind == WishKind::everything) return quoted(tag);
  if (level.begin > 0) tag.append("-").append(std::to_string(level.begin));
  tag.append("-").append(std::to_string(level.end - level.begin));
  return quoted(tag);
}

/// The wish that all wishes for the same prefix share as their Content-Location.
LodRequest shared_wish(const LodRequest& wish, const Resolution& level) {
  if (wish.kind == WishKind::chunks) return wish;
  if (level.chunk_count == 0) return {.kind = WishKind::bytes, .count = level.end};
  return {.kind = WishKind::chunks, .last_chunk = level.chunk_count - 1};
}

/// Answers a GET or HEAD by its route.
struct Responder {
  const HttpRequest& request;
  const HttpContext& context;

  HttpAnswer operator()(const UnknownRoute&) const { return not_found("no such resource"); }

  HttpAnswer operator()(const ViewerRoute& route) const {
    if (!route.id.empty() && context.access.is_public()) {  // a guarded server tells nothing
      const auto found = context.store.find(route.id);
      if (!found || !*found) return no_mesh(found, "no such mesh");
    }
    return text_answer("text/html; charset=utf-8", "no-cache", std::string(viewer_page()));
  }

  HttpAnswer operator()(const OpenapiRoute&) const {
    return text_answer("application/json", "no-cache", std::string(openapi_json()));
  }

  HttpAnswer operator()(const MetricsRoute&) const {
    if (!context.metrics_text) return not_found("the metrics are served elsewhere");
    return text_answer(kPrometheusType, "no-store", context.metrics_text());
  }

  HttpAnswer operator()(const HealthRoute&) const {
    return text_answer("application/json", "no-store", R"({"status":"ok"})");
  }

  HttpAnswer operator()(const CatalogRoute&) const {
    const std::shared_ptr<const Catalogue> catalogue = context.catalogue.get();
    HttpAnswer answer = text_answer("application/json", for_names(), "");
    answer.shared = {catalogue, &catalogue->json};
    answer.fields.add("ETag", catalogue->etag);
    answered_unchanged(answer, request, catalogue->etag);
    return answer;
  }

  HttpAnswer operator()(const MeshInfoRoute& route) const {
    const auto found = context.store.find(route.id);
    if (!found || !*found) return no_mesh(found, "no such mesh");
    const MeshPtr& mesh = *found;
    const std::string etag = quoted(mesh->hash_text() + "-info");
    HttpAnswer answer =
        text_answer("application/json", for_names(), mesh_info_json({mesh->id(), &mesh->index()}));
    answer.fields.add("ETag", etag);
    answered_unchanged(answer, request, etag);
    return answer;
  }

  HttpAnswer operator()(const MeshFileRoute& route) const {
    const auto found = context.store.find(route.id, route.hash);
    if (!found || !*found) return no_mesh(found, "no such mesh, or not with this hash");
    const MeshPtr& mesh = *found;
    const auto level = resolve(route.wish, mesh->index());
    if (!level) return error_answer(400, level.error().message);

    const std::string etag = level_etag(*mesh, route.wish, *level);
    HttpAnswer answer = file_answer(mesh, {level->begin, level->end}, etag);
    answer.fields.add("Accept-Ranges", "bytes");
    add_level_fields(answer.fields, level->faces, level->vertices, level->reached);
    answer.fields.add("PMesh-Chunks", std::to_string(level->chunk_count));
    if (route.wish.kind != WishKind::everything) {
      answer.fields.add("Content-Location",
                        file_target(mesh->id(), mesh->hash(), shared_wish(route.wish, *level)));
    }
    if (!answered_unchanged(answer, request, etag)) {
      apply_range(answer, request, etag, context.limits.ranges);
    }
    return answer;
  }

  /// Never a range: the route is for caches that refuse 206.
  HttpAnswer operator()(const ChunkRoute& route) const {
    const auto found = context.store.find(route.id, route.hash);
    if (!found || !*found) return no_mesh(found, "no such mesh, or not with this hash");
    const MeshPtr& mesh = *found;
    const auto& chunks = mesh->index().chunks;
    if (route.chunk >= chunks.size()) return not_found("no such chunk");
    const ChunkRow& row = chunks[static_cast<std::size_t>(route.chunk)];

    const std::string etag = quoted(mesh->hash_text() + "-c" + std::to_string(route.chunk));
    HttpAnswer answer = file_answer(mesh, {row.offset, row.end()}, etag);
    answer.fields.add("Accept-Ranges", "none");
    answered_unchanged(answer, request, etag);
    return answer;
  }

  /// All but the body, which take_lod() adds.
  HttpAnswer operator()(const LodRoute& route) const {
    const auto found = context.store.find(route.id);
    if (!found || !*found) return no_mesh(found, "no such mesh");
    const MeshPtr& mesh = *found;
    const auto level = resolve_lod(route.wish, mesh->index(), context.most_lod_faces);
    if (!level) return refused_lod(route.wish, *mesh, level.error());

    const LodRequest wish = canonical_wish(route.wish, *level, mesh->index());
    std::string tag = mesh->hash_text();
    tag.append("-").append(to_query(wish)).append("-").append(format_name(route.format));
    HttpAnswer answer = text_answer(media_type(route.format), for_names(), "");
    answer.fields.add("ETag", quoted(tag));
    answer.fields.add("Accept-Ranges", "none");
    if (answered_unchanged(answer, request, quoted(tag))) return answer;
    answer.lod_job = LodJob{mesh, route.wish, route.format, {}};
    return answer;
  }

  HttpAnswer refused_lod(const LodRequest& wish, const MeshFile& mesh, const Error& error) const {
    HttpAnswer answer = error_answer(400, error.message);
    const auto level = resolve(wish, mesh.index());
    if (level && level->faces > context.most_lod_faces) answer.limit = LimitName::lod_faces;
    return answer;
  }

  HttpAnswer operator()(const StreamRoute& route) const {
    const auto found = context.store.find(route.id);
    if (!found || !*found) return no_mesh(found, "no such mesh");
    if (!request.upgrade) {
      HttpAnswer answer = error_answer(426, "this is for WebSockets");
      answer.fields.add("Upgrade", "websocket");
      return answer;
    }
    HttpAnswer answer;
    answer.status = 101;
    answer.stream_id = route.id;
    return answer;
  }

  /// What a name stands for may be another thing at the next request.
  std::string_view for_names() const {
    return context.access.is_public() ? "no-cache" : "private, no-cache";
  }

  /// Bytes of a mesh's file, to be cached for ever under `etag`.
  HttpAnswer file_answer(MeshPtr mesh, ByteSpan span, std::string_view etag) const {
    HttpAnswer answer;
    answer.fields.add("Content-Type", "application/octet-stream");
    answer.fields.add("Cache-Control", context.access.is_public()
                                           ? "public, max-age=31536000, immutable, no-transform"
                                           : "private, max-age=31536000, immutable, no-transform");
    answer.fields.add("ETag", etag);
    answer.mesh = std::move(mesh);
    answer.span = span;
    return answer;
  }
};

/// What a route is called in the metrics, which mesh it is about, and whether all may have it.
struct RouteFacts {
  RouteName name = RouteName::other;
  std::string_view mesh_id{};
  bool is_open = false;
};

struct Describe {
  RouteFacts operator()(const UnknownRoute&) const { return {RouteName::other, {}, true}; }
  RouteFacts operator()(const ViewerRoute&) const { return {RouteName::viewer, {}, true}; }
  RouteFacts operator()(const OpenapiRoute&) const { return {RouteName::openapi, {}, true}; }
  RouteFacts operator()(const HealthRoute&) const { return {RouteName::health, {}, true}; }
  RouteFacts operator()(const MetricsRoute&) const { return {RouteName::metrics}; }
  RouteFacts operator()(const CatalogRoute&) const { return {RouteName::catalog}; }
  RouteFacts operator()(const MeshInfoRoute& route) const { return {RouteName::info, route.id}; }
  RouteFacts operator()(const MeshFileRoute& route) const { return {RouteName::file, route.id}; }
  RouteFacts operator()(const ChunkRoute& route) const { return {RouteName::chunk, route.id}; }
  RouteFacts operator()(const LodRoute& route) const { return {RouteName::lod, route.id}; }
  RouteFacts operator()(const StreamRoute& route) const { return {RouteName::stream, route.id}; }
};

bool is_operation(RouteName route) {
  return route == RouteName::health || route == RouteName::metrics;
}

HttpAnswer no_access(Access access) {
  HttpAnswer answer = access == Access::unauthenticated
                          ? error_answer(401, "a token or a signed URL is needed")
                          : error_answer(403, "the signature is wrong or has expired");
  if (access == Access::unauthenticated) answer.fields.add("WWW-Authenticate", kChallenge);
  answer.limit = LimitName::access;
  return answer;
}

/// A target without the signature that its query may hold.
struct UnsignedTarget {
  std::string_view text;                  // of the target that was split, or of `rest`
  std::optional<UrlSignature> signature;  // views of the target that was split
  std::string rest{};
};

/// `target`, split into `into`, which views it.
Status split_target(std::string_view target, UnsignedTarget& into) {
  into.text = target;
  const std::size_t question = target.find('?');
  if (question == std::string_view::npos) return {};
  const auto query = split_query(target.substr(question + 1));
  if (!query) return query.error();
  if (!query->signature) return {};
  into.signature = query->signature;
  into.rest = target.substr(0, question);
  if (!query->rest.empty()) into.rest.append("?").append(query->rest);
  into.text = into.rest;
  return {};
}

HttpAnswer answer_target(const HttpRequest& request, const HttpContext& context) {
  UnsignedTarget target;
  if (Status split = split_target(request.target, target); !split) {
    return error_answer(400, split.error().message);
  }
  const auto route = parse_target(target.text);
  if (!route) return error_answer(400, route.error().message);
  const RouteFacts facts = std::visit(Describe{}, *route);
  if (context.only_operation && !is_operation(facts.name)) return not_found("no such resource");
  const Access access = facts.is_open || context.only_operation
                            ? Access::granted
                            : context.access.judge({.authorization = request.authorization,
                                                    .signature = target.signature,
                                                    .mesh_id = facts.mesh_id,
                                                    .now = context.now});
  HttpAnswer answer = access == Access::granted ? std::visit(Responder{request, context}, *route)
                                                : no_access(access);
  answer.route = facts.name;
  return answer;
}

}  // namespace

HttpAnswer answer_http(const HttpRequest& request, const HttpContext& context) {
  if (request.method == "OPTIONS") return preflight();
  if (request.method != "GET" && request.method != "HEAD") {
    HttpAnswer answer = error_answer(405, "only GET, HEAD and OPTIONS are answered");
    answer.fields.add("Allow", kMethods);
    return answer;
  }
  HttpAnswer answer = answer_target(request, context);
  answer.head_only = request.method == "HEAD";
  return answer;
}

void take_lod(HttpAnswer& answer, const LodOutcome& outcome) {
  answer.lod_job.reset();
  if (outcome.file) {
    const LodFilePtr& file = *outcome.file;
    answer.shared = {file, &file->bytes};
    add_level_fields(answer.fields, file->faces, file->vertices, file->reached);
    return;
  }
  const bool is_busy = outcome.file.error().code == ErrorCode::out_of_resources;
  HttpAnswer failed = is_busy ? busy_answer(503, "too many levels of detail are being made")
                              : error_answer(500, "the level of detail could not be made");
  failed.route = answer.route;
  failed.head_only = answer.head_only;
  failed.limit = outcome.limit;
  answer = std::move(failed);
}

}  // namespace pmesh
