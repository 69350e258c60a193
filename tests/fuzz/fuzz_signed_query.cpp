// The query of a URL and its signature. Whatever stands there, a signature that is added is found,
// the rest is left as it was, and no signature is right by accident.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "server/access/access_policy.h"

namespace {

using namespace pmesh;

constexpr std::uint64_t kNow = 1'800'000'000;
const std::string kKey(32, 'k');

void require(bool condition) {
  if (!condition) std::abort();
}

Access judge(const AccessPolicy& policy, const SplitQuery& split) {
  return policy.judge({.signature = split.signature, .mesh_id = "bunny", .now = kNow});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const AccessPolicy policy({.tokens = {"0123456789abcdef"}, .url_key = kKey});
  const std::string_view query(reinterpret_cast<const char*>(data), size);
  const auto split = split_query(query);
  if (!split) return 0;
  require(judge(policy, *split) != Access::granted);
  require(split->rest.size() <= query.size());

  const std::string signed_query = split->rest + "&" + sign_query(kKey, "bunny", kNow);
  const auto again = split_query(signed_query);
  require(again && again->rest == split->rest);
  require(judge(policy, *again) == Access::granted);
  return 0;
}
