// What the server answers to an HTTP request: a function of the request and the mesh store, without
// sockets (docs/protocol.md, section 2). A session sends the answer as it is.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "protocol/byte_range.h"
#include "server/http/header_fields.h"
#include "server/store/mesh_store.h"

namespace pmesh {

inline constexpr std::size_t kMaxTargetBytes = 8192;

/// The parts of a request that matter. The views belong to whoever parsed it.
struct HttpRequest {
  std::string_view method{};
  std::string_view target{};
  std::string_view range{};  ///< These three: the field's value; empty if there is none.
  std::string_view if_range{};
  std::string_view if_none_match{};
};

struct HttpAnswer {
  int status = 200;
  HeaderFields fields;  ///< All but Date, Content-Length and Connection, which the session knows.
  std::string text;     ///< The body, if there is no mesh.
  MeshPtr mesh;         ///< If not null the body is `span` of its file.
  ByteSpan span;
  bool head_only = false;  ///< Send no body: the request was HEAD.

  std::uint64_t body_bytes() const { return mesh ? span.size() : text.size(); }
  /// 204 and 304 have no body, and no Content-Length either.
  bool may_have_body() const { return status != 204 && status != 304; }
};

/// The one answer to `request`. Threads: as MeshStore.
HttpAnswer answer_http(const HttpRequest& request, MeshStore& store);

/// An answer that is only an error, for what never became a request too.
HttpAnswer error_answer(int status, std::string_view message);

/// Status line and fields up to the empty line. `date` as HTTP spells it (RFC 9110, 5.6.7).
std::string head_text(const HttpAnswer& answer, std::string_view date, bool keep_alive);

}  // namespace pmesh
