#include "server/http/http_answer.h"

#include <variant>

#include "protocol/catalogue_json.h"
#include "protocol/routes.h"

namespace pmesh {
namespace {

constexpr std::string_view kMethods = "GET, HEAD, OPTIONS";
constexpr std::string_view kExposed =
    "ETag, Content-Range, Content-Length, Accept-Ranges, Content-Location, PMesh-Faces, "
    "PMesh-Vertices, PMesh-Chunks, PMesh-Reached";
constexpr std::string_view kForever = "public, max-age=31536000, immutable, no-transform";

std::string quoted(std::string_view text) { return std::string("\"").append(text).append("\""); }

/// An answer with the fields that every answer has.
HttpAnswer plain_answer(int status) {
  HttpAnswer answer;
  answer.status = status;
  answer.fields.add("Access-Control-Allow-Origin", "*");
  answer.fields.add("Access-Control-Expose-Headers", kExposed);
  return answer;
}

HttpAnswer text_answer(int status, std::string_view type, std::string text) {
  HttpAnswer answer = plain_answer(status);
  answer.fields.add("Content-Type", type);
  answer.text = std::move(text);
  return answer;
}

HttpAnswer json_answer(std::string_view cache_control, std::string json) {
  HttpAnswer answer = text_answer(200, "application/json", std::move(json));
  answer.fields.add("Cache-Control", cache_control);
  return answer;
}

HttpAnswer preflight() {
  HttpAnswer answer = plain_answer(204);
  answer.fields.add("Access-Control-Allow-Methods", kMethods);
  answer.fields.add("Access-Control-Allow-Headers", "Range, If-Range, If-None-Match");
  answer.fields.add("Access-Control-Max-Age", "86400");
  return answer;
}

HttpAnswer not_found(std::string_view what) { return error_answer(404, what); }

/// The answer if `found` is not a mesh.
HttpAnswer no_mesh(const Result<MeshPtr>& found, std::string_view not_found_text) {
  if (found) return not_found(not_found_text);
  HttpAnswer answer = error_answer(503, "the mesh cannot be read now");
  answer.fields.add("Retry-After", "1");
  return answer;
}

/// The entity tag without a leading "W/": If-None-Match compares weakly.
std::string_view opaque_tag(std::string_view tag) {
  if (tag.starts_with("W/")) tag.remove_prefix(2);
  return tag;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Whether a comma-separated list of tags, or "*", holds `etag`. Our tags hold no commas.
bool lists_tag(std::string_view list, std::string_view etag) {
  if (trimmed(list) == "*") return true;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    if (opaque_tag(trimmed(list.substr(0, comma))) == etag) return true;
    list = comma == std::string_view::npos ? std::string_view() : list.substr(comma + 1);
  }
  return false;
}

/// Turns `answer`, which has its fields, into a 304 if the client has it already.
bool answered_unchanged(HttpAnswer& answer, const HttpRequest& request, std::string_view etag) {
  if (!lists_tag(request.if_none_match, etag)) return false;
  answer.status = 304;
  answer.text.clear();
  answer.mesh = nullptr;
  return true;
}

/// Cuts the answer's span to the range asked for, if one is asked for and may be.
void apply_range(HttpAnswer& answer, const HttpRequest& request, std::string_view etag) {
  const bool applies =
      request.method == "GET" && (request.if_range.empty() || trimmed(request.if_range) == etag);
  if (!applies) return;
  const std::uint64_t length = answer.span.size();
  const RangeChoice choice = choose_range(trimmed(request.range), length);
  if (choice.kind == RangeKind::whole) return;
  if (choice.kind == RangeKind::unsatisfiable) {
    answer = error_answer(416, "the range is beyond the end");
    answer.fields.add("Content-Range", "bytes */" + std::to_string(length));
    return;
  }
  const auto [begin, end] = choice.span;
  answer.status = 206;
  answer.fields.add("Content-Range", "bytes " + std::to_string(begin) + "-" +
                                         std::to_string(end - 1) + "/" + std::to_string(length));
  answer.span = {answer.span.begin + begin, answer.span.begin + end};
}

/// Bytes of a mesh's file, to be cached for ever under `etag`.
HttpAnswer file_answer(MeshPtr mesh, ByteSpan span, std::string_view etag) {
  HttpAnswer answer = plain_answer(200);
  answer.fields.add("Content-Type", "application/octet-stream");
  answer.fields.add("Cache-Control", kForever);
  answer.fields.add("ETag", etag);
  answer.mesh = std::move(mesh);
  answer.span = span;
  return answer;
}

void add_level_fields(HeaderFields& fields, const Resolution& level) {
  fields.add("PMesh-Faces", std::to_string(level.faces));
  fields.add("PMesh-Vertices", std::to_string(level.vertices));
  fields.add("PMesh-Chunks", std::to_string(level.chunk_count));
  fields.add("PMesh-Reached", level.reached ? "1" : "0");
}

/// One tag for all wishes that come to the same bytes.
std::string level_etag(const MeshFile& mesh, const LodRequest& wish, const Resolution& level) {
  std::string tag = to_hex(mesh.hash());
  if (wish.kind == WishKind::everything) return quoted(tag);
  if (level.begin > 0) tag.append("-").append(std::to_string(level.begin));
  tag.append("-").append(std::to_string(level.end - level.begin));
  return quoted(tag);
}

/// The wish that all wishes for the same prefix share as their Content-Location.
LodRequest canonical_wish(const LodRequest& wish, const Resolution& level) {
  if (wish.kind == WishKind::chunks) return wish;
  if (level.chunk_count == 0) return {.kind = WishKind::bytes, .count = level.end};
  return {.kind = WishKind::chunks, .last_chunk = level.chunk_count - 1};
}

/// Answers a GET or HEAD by its route.
struct Responder {
  const HttpRequest& request;
  MeshStore& store;

  HttpAnswer operator()(const UnknownRoute&) const { return not_found("no such resource"); }

  HttpAnswer operator()(const HealthRoute&) const {
    return json_answer("no-store", R"({"status":"ok"})");
  }

  HttpAnswer operator()(const CatalogRoute&) const {
    const std::vector<MeshPtr> meshes = store.list();
    std::vector<CatalogueEntry> entries;
    for (const MeshPtr& mesh : meshes) entries.push_back({mesh->id(), &mesh->index()});
    return json_answer("no-cache", catalogue_json(entries));
  }

  HttpAnswer operator()(const MeshInfoRoute& route) const {
    const auto found = store.find(route.id);
    if (!found || !*found) return no_mesh(found, "no such mesh");
    const MeshPtr& mesh = *found;
    const std::string etag = quoted(to_hex(mesh->hash()) + "-info");
    HttpAnswer answer = json_answer("no-cache", mesh_info_json({mesh->id(), &mesh->index()}));
    answer.fields.add("ETag", etag);
    answered_unchanged(answer, request, etag);
    return answer;
  }

  HttpAnswer operator()(const MeshFileRoute& route) const {
    const auto found = store.find(route.id, route.hash);
    if (!found || !*found) return no_mesh(found, "no such mesh, or not with this hash");
    const MeshPtr& mesh = *found;
    const auto level = resolve(route.wish, mesh->index());
    if (!level) return error_answer(400, level.error().message);

    const std::string etag = level_etag(*mesh, route.wish, *level);
    HttpAnswer answer = file_answer(mesh, {level->begin, level->end}, etag);
    answer.fields.add("Accept-Ranges", "bytes");
    add_level_fields(answer.fields, *level);
    if (route.wish.kind != WishKind::everything) {
      answer.fields.add("Content-Location",
                        file_target(mesh->id(), mesh->hash(), canonical_wish(route.wish, *level)));
    }
    if (!answered_unchanged(answer, request, etag)) apply_range(answer, request, etag);
    return answer;
  }

  /// Never a range: the route is for caches that refuse 206.
  HttpAnswer operator()(const ChunkRoute& route) const {
    const auto found = store.find(route.id, route.hash);
    if (!found || !*found) return no_mesh(found, "no such mesh, or not with this hash");
    const MeshPtr& mesh = *found;
    const auto& chunks = mesh->index().chunks;
    if (route.chunk >= chunks.size()) return not_found("no such chunk");
    const ChunkRow& row = chunks[static_cast<std::size_t>(route.chunk)];

    const std::string etag = quoted(to_hex(mesh->hash()) + "-c" + std::to_string(route.chunk));
    HttpAnswer answer = file_answer(mesh, {row.offset, row.end()}, etag);
    answer.fields.add("Accept-Ranges", "none");
    answered_unchanged(answer, request, etag);
    return answer;
  }
};

std::string_view reason_phrase(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 206:
      return "Partial Content";
    case 304:
      return "Not Modified";
    case 400:
      return "Bad Request";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 416:
      return "Range Not Satisfiable";
    case 431:
      return "Request Header Fields Too Large";
    case 503:
      return "Service Unavailable";
    default:
      return "Error";
  }
}

}  // namespace

HttpAnswer answer_http(const HttpRequest& request, MeshStore& store) {
  if (request.method == "OPTIONS") return preflight();
  if (request.method != "GET" && request.method != "HEAD") {
    HttpAnswer answer = error_answer(405, "only GET, HEAD and OPTIONS are answered");
    answer.fields.add("Allow", kMethods);
    return answer;
  }
  HttpAnswer answer;
  if (request.target.size() > kMaxTargetBytes) {
    answer = error_answer(414, "the request target is too long");
  } else if (const auto route = parse_target(request.target); !route) {
    answer = error_answer(400, route.error().message);
  } else {
    answer = std::visit(Responder{request, store}, *route);
  }
  answer.head_only = request.method == "HEAD";
  return answer;
}

HttpAnswer error_answer(int status, std::string_view message) {
  HttpAnswer answer = text_answer(status, "text/plain; charset=utf-8", std::string(message) + "\n");
  answer.fields.add("Cache-Control", "no-store");
  return answer;
}

std::string head_text(const HttpAnswer& answer, std::string_view date, bool keep_alive) {
  std::string head = "HTTP/1.1 " + std::to_string(answer.status) + " ";
  head.append(reason_phrase(answer.status)).append("\r\nDate: ").append(date).append("\r\n");
  head.append(answer.fields.lines());
  if (answer.may_have_body()) {
    head.append("Content-Length: ").append(std::to_string(answer.body_bytes())).append("\r\n");
  }
  head.append(keep_alive ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n");
  return head;
}

}  // namespace pmesh
