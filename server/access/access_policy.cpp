#include "server/access/access_policy.h"

#include <algorithm>
#include <cassert>

#include <openssl/crypto.h>
#include <openssl/evp.h>

#include "protocol/letters.h"

namespace pmesh {

AccessPolicy::AccessPolicy(const AccessOptions& options) : url_key_(options.url_key) {
  for (const std::string& token : options.tokens) token_digests_.push_back(digest_of(token));
}

/// Digests have one length, so that comparing them does not tell a token's.
AccessPolicy::Digest AccessPolicy::digest_of(std::string_view token) {
  Digest digest{};
  [[maybe_unused]] const int done =
      EVP_Digest(token.data(), token.size(), digest.data(), nullptr, EVP_sha256(), nullptr);
  assert(done == 1);
  return digest;
}

bool AccessPolicy::knows_token(std::string_view authorization) const {
  constexpr std::string_view kScheme = "bearer ";
  if (!begins_in_any_case(authorization, kScheme)) return false;
  authorization.remove_prefix(kScheme.size());
  authorization.remove_prefix(std::min(authorization.size(), authorization.find_first_not_of(' ')));
  const Digest digest = digest_of(authorization);
  int found = 0;  // every token is compared, wherever the right one stands
  for (const Digest& known : token_digests_) {
    found |= static_cast<int>(CRYPTO_memcmp(known.data(), digest.data(), digest.size()) == 0);
  }
  return found != 0;
}

Access AccessPolicy::judge(const AccessRequest& request) const {
  if (is_public() || knows_token(request.authorization)) return Access::granted;
  if (!request.signature || url_key_.empty()) return Access::unauthenticated;
  const bool is_signed =
      !request.mesh_id.empty() &&
      is_valid_signature(*request.signature, url_key_, request.mesh_id, request.now);
  return is_signed ? Access::granted : Access::forbidden;
}

}  // namespace pmesh
