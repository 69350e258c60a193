#include "client/http_transport.h"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/catalogue_json.h"
#include "protocol/routes.h"

namespace pmesh {
namespace {

constexpr std::size_t kMaxInfoBytes = 8 * 1024 * 1024;

// Hands a body to `sink` with the file offset at which each piece begins: what was asked for, or
// the file's start if the host has ignored the range.
struct BodyOffsets {
  const ByteSink& sink;
  std::uint64_t offset = 0;

  // A 206 may begin no later than was asked; a 200 begins at 0.
  TransportStatus begin(const HttpResponse& response, std::uint64_t asked,
                        const std::string& name) {
    offset = response.content_range ? response.content_range->begin : 0;
    if (response.status == 200) offset = 0;
    const bool is_gap = offset > asked || (response.status == 206 && !response.content_range);
    if (!is_gap) return std::nullopt;
    return final_error(runtime_error(name + ": the host sent another range than was asked for"));
  }

  bool operator()(ByteView bytes) {
    const std::uint64_t begin = offset;
    offset += bytes.size();
    return sink(begin, bytes);
  }
};

}  // namespace

HttpMeshTransport::HttpMeshTransport(HttpMesh mesh, const TransportOptions& options)
    : mesh_(std::move(mesh)), client_(mesh_.endpoint, options) {}

TransportStatus HttpMeshTransport::open() {
  const std::string target = mesh_.prefix + "/" + mesh_.id;
  std::string json;
  const auto on_head = [&](const HttpResponse& response) {
    return client_.check_status(response, target);
  };
  const auto on_body = [&](ByteView bytes) {
    json.append(bytes.begin(), bytes.end());
    return json.size() <= kMaxInfoBytes;
  };
  if (auto failed = client_.get(target, std::nullopt, on_head, on_body)) return failed;
  const Result<MeshInfo> info = parse_mesh_info(json);
  if (!info) {
    return final_error(
        prefixed(client_.url_of(target) + ": not an answer of a pmesh server", info.error()));
  }
  remote_ = {info->hash, info->file_bytes};
  return std::nullopt;
}

TransportStatus HttpMeshTransport::read(const ReadRequest& request, const ByteSink& sink) {
  const LodRequest wish = request.end ? LodRequest{} : request.wish;
  const std::string target = mesh_.prefix + file_target(mesh_.id, *remote_.hash, wish);
  std::optional<ByteSpan> range;
  if (request.end) range = ByteSpan{request.from, *request.end};
  BodyOffsets body{sink};
  bool is_refused = false;
  const auto on_head = [&](const HttpResponse& response) -> TransportStatus {
    is_refused = response.status == 400 && !request.end;
    if (is_refused) return std::nullopt;
    TransportStatus failed = client_.check_status(response, target);
    return failed ? failed : body.begin(response, request.from, client_.url_of(target));
  };
  const auto on_body = [&](ByteView bytes) { return !is_refused && body(bytes); };
  const TransportStatus failed = client_.get(target, range, on_head, on_body);
  if (failed || !is_refused) return failed;
  return read({request.from, request.from + kMaxPrologueBytes, {}}, sink);
}

HttpFileTransport::HttpFileTransport(HttpFile file, const TransportOptions& options)
    : file_(std::move(file)), client_(file_.endpoint, options) {}

TransportStatus HttpFileTransport::open() {
  client_.close();
  remote_ = {};
  return std::nullopt;
}

TransportStatus HttpFileTransport::read(const ReadRequest& request, const ByteSink& sink) {
  const ByteSpan range{request.from, request.end.value_or(request.from + kMaxPrologueBytes)};
  BodyOffsets body{sink};
  bool is_past_end = false;
  const auto on_head = [&](const HttpResponse& response) -> TransportStatus {
    if (auto failed = take_head(response)) return failed;
    is_past_end = response.status == 416;
    return is_past_end ? std::nullopt
                       : body.begin(response, request.from, client_.url_of(file_.target));
  };
  const auto on_body = [&](ByteView bytes) { return !is_past_end && body(bytes); };
  return client_.get(file_.target, range, on_head, on_body);
}

// Learns the file's size. A 416 that tells it is an answer too: nothing is left to read.
TransportStatus HttpFileTransport::take_head(const HttpResponse& response) {
  if (response.status == 200) remote_.available_bytes = response.content_length;
  if (response.total_bytes) remote_.available_bytes = response.total_bytes;
  if (response.status == 416 && response.total_bytes) return std::nullopt;
  return client_.check_status(response, file_.target);
}

}  // namespace pmesh
