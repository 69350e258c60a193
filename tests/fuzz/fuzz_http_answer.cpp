// The HTTP server without its sockets and its parser. The input is a request as lines: method,
// target, Range, If-Range, If-None-Match, Authorization. Whatever it says there must be one answer.
#include "tests/fuzz/http_checks.h"

namespace {

using namespace pmesh;

std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}

HttpRequest request_from(std::string_view text) {
  HttpRequest request;
  for (std::string_view* field :
       {&request.method, &request.target, &request.range, &request.if_range}) {
    *field = take_line(text);
  }
  request.if_none_match = take_line(text);
  request.authorization = take_line(text);
  return request;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  checked_answer(request_from({reinterpret_cast<const char*>(data), size}));
  return 0;
}
