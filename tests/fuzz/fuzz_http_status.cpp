// What an HTTP host says to the client: a Content-Range field, a Retry-After field and the JSON of
// a mesh, a line each (the JSON is the rest).
#include <cstdlib>

#include "client/http_status.h"
#include "protocol/catalogue_json.h"
#include "protocol/mesh_id.h"

namespace {

using namespace pmesh;

void require(bool condition) {
  if (!condition) std::abort();
}

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  HttpResponse response;
  parse_content_range(take_line(text), response);
  if (response.content_range) require(response.content_range->begin < response.content_range->end);
  const auto retry_after = parse_retry_after(take_line(text));
  if (retry_after) require(*retry_after >= std::chrono::seconds(0));
  if (retry_after) require(*retry_after <= std::chrono::hours(24));
  if (const auto info = parse_mesh_info(text)) {
    require(is_mesh_id(info->id) && info->url.starts_with('/'));
  }
  return 0;
}
