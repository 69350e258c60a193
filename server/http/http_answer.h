// What the server answers to an HTTP request: a function of the request and the mesh store, without
// sockets (docs/protocol.md, section 2). A session sends the answer as it is.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/bytes.h"
#include "protocol/byte_range.h"
#include "server/access/access_policy.h"
#include "server/http/catalogue_cache.h"
#include "server/http/header_fields.h"
#include "server/lod/lod_service.h"
#include "server/metrics/metrics.h"
#include "server/options.h"
#include "server/store/mesh_store.h"

namespace pmesh {

/// The parts of a request that matter. The views belong to whoever parsed it.
struct HttpRequest {
  std::string_view method{};
  std::string_view target{};
  /// A field's value, as those below; empty if there is none. Of Range and If-Range there must be
  /// one, or no range is asked for.
  std::string_view range{};
  std::string_view if_range{};
  std::string if_none_match{};  ///< All such fields as one list.
  std::string_view authorization{};
  bool upgrade = false;  ///< It asks for a WebSocket.
};

/// What an answer depends on besides the request. All of it outlives the call.
struct HttpContext {
  MeshStore& store;
  CatalogueCache& catalogue;  ///< Of the store.
  const AccessPolicy& access;
  const SessionLimits& limits;
  std::uint64_t most_lod_faces = 0;
  std::uint64_t now = 0;  ///< Unix time in seconds.
  /// The text of /metrics; empty if that is not served here.
  const std::function<std::string()>& metrics_text;
  /// Serve /metrics and /health to all who can connect, and nothing else.
  bool only_operation = false;
};

struct HttpAnswer {
  int status = 200;
  RouteName route = RouteName::other;
  std::optional<LimitName> limit;  ///< That the request met.
  HeaderFields fields;  ///< All but Date, Content-Length and Connection, which the session knows.

  std::string text;  ///< The body, if it is none of those below.
  MeshPtr mesh;      ///< If not null the body is `span` of its file.
  ByteSpan span;
  std::shared_ptr<const Bytes> shared;  ///< If not null the body is these, which others get too.

  /// What is still to be done: take_lod() completes the answer with what comes of the job.
  std::optional<LodJob> lod_job;
  /// With status 101: the mesh whose URL is to become a WebSocket. The session does that.
  std::string stream_id;

  bool head_only = false;  ///< Send no body: the request was HEAD.

  std::uint64_t body_bytes() const { return mesh ? span.size() : body().size(); }
  /// The body, if it is not of a mesh's file.
  ByteView body() const { return shared ? ByteView(*shared) : as_bytes(text); }
  /// 204 and 304 have no body, and no Content-Length either.
  bool may_have_body() const { return status != 204 && status != 304; }
};

/// The one answer to `request`. Threads: as MeshStore.
HttpAnswer answer_http(const HttpRequest& request, const HttpContext& context);

/// Completes an answer that has a lod_job.
void take_lod(HttpAnswer& answer, const LodOutcome& outcome);

/// An answer that is only an error, for what never became a request too.
HttpAnswer error_answer(int status, std::string_view message);
/// The same for one that may be asked again a second later.
HttpAnswer busy_answer(int status, std::string_view message);

/// Status line and fields up to the empty line. `date` as HTTP spells it (RFC 9110, 5.6.7).
std::string head_text(const HttpAnswer& answer, std::string_view date, bool keep_alive);

}  // namespace pmesh
