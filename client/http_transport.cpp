#include "client/http_transport.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "protocol/catalogue_json.h"
#include "protocol/routes.h"

namespace pmesh {
namespace {

constexpr std::size_t kMaxInfoBytes = 8 * 1024 * 1024;

// A whole file where a range was asked is declined so often in a row, if it begins with more bytes
// that are held already than these.
constexpr int kMostDeclined = 2;
constexpr std::uint64_t kMostSkipped = 64 * 1024;

// Hands a body to `sink` with the file offset at which each piece begins: what was asked for, or
// the file's start if the host has ignored the range.
struct RangeBody {
  const ByteSink& sink;
  std::uint64_t offset = 0;
  bool is_declined = false;  // Ends it after its first bytes, which count as fetched.

  // A 206 may begin no later than was asked; a 200 begins at 0.
  TransportStatus begin(const HttpResponse& response, std::uint64_t asked, int& whole_answers,
                        const std::string& url) {
    if (response.status == 200) {
      is_declined = asked > kMostSkipped && whole_answers < kMostDeclined;
      whole_answers += is_declined ? 1 : 0;
      return std::nullopt;
    }
    whole_answers = 0;
    if (response.content_range && response.content_range->begin <= asked) {
      offset = response.content_range->begin;
      return std::nullopt;
    }
    return final_error(runtime_error(url + ": the host sent another range than was asked for"));
  }

  bool operator()(ByteView bytes) {
    const std::uint64_t begin = offset;
    offset += bytes.size();
    return sink(begin, bytes) && !is_declined;
  }
};

// The range that is missing, if anything is held or known of the file.
std::optional<ByteSpan> range_of(const ReadRequest& request, std::uint64_t file_bytes) {
  if (!request.end && request.from == 0) return std::nullopt;
  return ByteSpan{request.from, std::max(request.end.value_or(file_bytes), request.from + 1)};
}

bool is_not_found(const HttpResponse& response) {
  return response.status == 404 || response.status == 410;
}

}  // namespace

HttpMeshTransport::HttpMeshTransport(HttpMesh mesh, const TransportOptions& options)
    : mesh_(std::move(mesh)), client_(mesh_.endpoint, options) {}

std::string HttpMeshTransport::target_of(const std::string& route) const {
  std::string target = mesh_.prefix + route;
  if (mesh_.query.empty()) return target;
  target += route.find('?') == std::string::npos ? '?' : '&';
  return target += mesh_.query;
}

TransportStatus HttpMeshTransport::open() {
  client_.close();
  whole_answers_ = 0;
  return remote_.hash ? std::nullopt : look_up();
}

TransportStatus HttpMeshTransport::look_up() {
  const std::string target = target_of("/" + mesh_.id);
  const std::string url = client_.url_of(target);
  std::string json;
  const auto on_head = [&](const HttpResponse& response) { return check_status(response, url); };
  const auto on_body = [&](ByteView bytes) {
    json.append(bytes.begin(), bytes.end());
    return json.size() <= kMaxInfoBytes;
  };
  if (auto failed = client_.get(target, std::nullopt, on_head, on_body)) return failed;
  const Result<MeshInfo> info = parse_mesh_info(json);
  if (!info) return final_error(prefixed(url + ": not an answer of a pmesh server", info.error()));
  remote_ = {info->hash, info->file_bytes};
  return std::nullopt;
}

TransportStatus HttpMeshTransport::read(const ReadRequest& request, const ByteSink& sink) {
  for (;;) {
    const bool is_in_chunks = request.index != nullptr && request.from >= request.index->base_end();
    if (whole_answers_ == kMostDeclined && has_chunk_routes_ && is_in_chunks) {
      return read_chunk(request, sink);
    }
    bool is_declined = false;
    const TransportStatus failed = read_file(request, sink, is_declined);
    if (failed || !is_declined) return failed;
  }
}

TransportStatus HttpMeshTransport::read_file(const ReadRequest& request, const ByteSink& sink,
                                             bool& is_declined) {
  const LodRequest wish = request.end ? LodRequest{} : request.wish;
  const std::string target = target_of(file_target(mesh_.id, *remote_.hash, wish));
  RangeBody body{sink};
  bool is_refused = false;
  const auto on_head = [&](const HttpResponse& response) -> TransportStatus {
    is_refused = response.status == 400 && !request.end;
    if (is_refused) return std::nullopt;
    if (auto failed = check(response, target)) return failed;
    return body.begin(response, request.from, whole_answers_, client_.url_of(target));
  };
  const auto on_body = [&](ByteView bytes) { return !is_refused && body(bytes); };
  const std::optional<ByteSpan> range = range_of(request, *remote_.available_bytes);
  const TransportStatus failed = client_.get(target, range, on_head, on_body);
  is_declined = body.is_declined;
  if (failed || !is_refused) return failed;
  return read({request.from, request.from + kMaxPrologueBytes, {}}, sink);
}

// Reads the rest of the chunk in which the request begins, and what stands before that in it.
TransportStatus HttpMeshTransport::read_chunk(const ReadRequest& request, const ByteSink& sink) {
  const std::vector<ChunkRow>& chunks = request.index->chunks;
  const auto next = std::ranges::upper_bound(chunks, request.from, {}, &ChunkRow::offset);
  const auto number = static_cast<std::uint64_t>(next - chunks.begin()) - 1;
  const std::string target = target_of(chunk_target(mesh_.id, *remote_.hash, number));
  RangeBody body{sink, chunks[number].offset};
  const auto on_head = [&](const HttpResponse& response) -> TransportStatus {
    has_chunk_routes_ = !is_not_found(response);
    return has_chunk_routes_ ? check(response, target) : std::nullopt;
  };
  const auto on_body = [&](ByteView bytes) { return has_chunk_routes_ && body(bytes); };
  const TransportStatus failed = client_.get(target, std::nullopt, on_head, on_body);
  return failed || has_chunk_routes_ ? failed : read(request, sink);
}

// The status of a target that names the hash: if that is not found, the file may have been
// replaced, and the next open() must ask for its hash again.
TransportStatus HttpMeshTransport::check(const HttpResponse& response, const std::string& target) {
  TransportStatus failed = check_status(response, client_.url_of(target));
  if (failed && is_not_found(response)) {
    remote_ = {};
    failed->retryable = true;
  }
  return failed;
}

HttpFileTransport::HttpFileTransport(HttpFile file, const TransportOptions& options)
    : file_(std::move(file)), client_(file_.endpoint, options) {}

TransportStatus HttpFileTransport::open() {
  client_.close();
  remote_ = {};
  whole_answers_ = 0;
  return std::nullopt;
}

TransportStatus HttpFileTransport::read(const ReadRequest& request, const ByteSink& sink) {
  for (;;) {
    bool is_declined = false;
    const TransportStatus failed = read_range(request, sink, is_declined);
    if (failed || !is_declined) return failed;
  }
}

TransportStatus HttpFileTransport::read_range(const ReadRequest& request, const ByteSink& sink,
                                              bool& is_declined) {
  const ByteSpan range{request.from, request.end.value_or(request.from + kMaxPrologueBytes)};
  RangeBody body{sink};
  bool is_past_end = false;
  const auto on_head = [&](const HttpResponse& response) -> TransportStatus {
    if (auto failed = take_head(response)) return failed;
    is_past_end = response.status == 416;
    if (is_past_end) return std::nullopt;
    return body.begin(response, request.from, whole_answers_, client_.url_of(file_.target));
  };
  const auto on_body = [&](ByteView bytes) { return !is_past_end && body(bytes); };
  const TransportStatus failed = client_.get(file_.target, range, on_head, on_body);
  is_declined = body.is_declined;
  return failed;
}

// Learns the file's size. A 416 that tells it is an answer too: nothing is left to read.
TransportStatus HttpFileTransport::take_head(const HttpResponse& response) {
  if (response.status == 200) remote_.available_bytes = response.content_length;
  if (response.total_bytes) remote_.available_bytes = response.total_bytes;
  if (response.status == 416 && response.total_bytes) return std::nullopt;
  return check_status(response, client_.url_of(file_.target));
}

}  // namespace pmesh
