// The HTTP server without its sockets. The input is a request as lines: method, target, Range,
// If-Range, If-None-Match. Whatever it says there must be one answer, and no byte of it outside
// the file.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "server/http/http_answer.h"
#include "tests/fixtures/temporary_directory.h"
#include "tests/server/sample_file.h"

namespace {

using namespace pmesh;

void require(bool condition) {
  if (!condition) std::abort();
}

/// A store with the meshes "bunny" and "measured"; seeds know their hashes, always the same.
MeshStore& store() {
  static const TemporaryDirectory directory;
  static const std::string bunny = directory.write("bunny.pmesh", testing::make_sample().bytes);
  static const std::string measured =
      directory.write("measured.pmesh", testing::make_measured_sample().bytes);
  static const std::unique_ptr<MeshStore> opened = MeshStore::open(directory / "").value();
  return *opened;
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

HttpRequest request_from(std::string_view text) {
  HttpRequest request;
  for (std::string_view* field : {&request.method, &request.target, &request.range,
                                  &request.if_range, &request.if_none_match}) {
    *field = take_line(text);
  }
  return request;
}

bool is_known_status(int status) {
  constexpr std::array kStatuses = {200, 204, 206, 304, 400, 404, 405, 414, 416};
  return std::find(kStatuses.begin(), kStatuses.end(), status) != kStatuses.end();
}

void check_head(const HttpAnswer& answer) {
  const std::string head = head_text(answer, "today", true);
  require(head.starts_with("HTTP/1.1 ") && head.find("\r\n\r\n") == head.size() - 4);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const HttpRequest request = request_from({reinterpret_cast<const char*>(data), size});
  const HttpAnswer answer = answer_http(request, store());
  require(is_known_status(answer.status));
  check_head(answer);
  require(answer.head_only == (request.method == "HEAD"));
  if (answer.mesh) {
    require(answer.status == 200 || answer.status == 206);
    require(answer.span.begin < answer.span.end && answer.span.end <= answer.mesh->file_bytes());
  }
  return 0;
}
