// The config file of `pmesh serve`. What is taken is printed, and read back as the same.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "server/config/load_config.h"

namespace {

using namespace pmesh;

void require(bool condition) {
  if (!condition) std::abort();
}

Status read_config(std::string_view text, ServeConfig& config) {
  const auto members = parse_config(text);
  if (!members) return members.error();
  return apply_members(*members, "config", config);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ServeConfig config;
  const Status read = read_config({reinterpret_cast<const char*>(data), size}, config);
  if (!read) {
    require(!read.error().message.empty() && read.error().code == ErrorCode::usage);
    return 0;
  }
  const std::string printed = print_config(config);
  ServeConfig again;
  require(read_config(printed, again).ok());
  require(print_config(again) == printed);
  return 0;
}
