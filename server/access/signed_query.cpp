#include "server/access/signed_query.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include "core/base/parse_number.h"
#include "core/pm/format.h"

namespace pmesh {
namespace {

using Signature = std::array<std::uint8_t, 32>;

/// HMAC-SHA256 over a text that no other use of the key can have.
Signature signature_of(std::string_view key, std::string_view id, std::uint64_t expires) {
  const std::string text =
      std::string("pmesh signed url\n").append(id).append("\n").append(std::to_string(expires));
  Signature signature{};
  unsigned size = 0;
  [[maybe_unused]] const auto* done = HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
                                           reinterpret_cast<const unsigned char*>(text.data()),
                                           text.size(), signature.data(), &size);
  assert(done != nullptr && size == signature.size());
  return signature;
}

/// Puts the value of `piece` into `value` if its name is `name`; the failure is that it is there
/// already.
Result<bool> taken(std::string_view piece, std::string_view name,
                   std::optional<std::string_view>& value) {
  if (!piece.starts_with(name) || !piece.substr(name.size()).starts_with('=')) return false;
  if (value) return Error{ErrorCode::usage, "the query has " + std::string(name) + " twice"};
  value = piece.substr(name.size() + 1);
  return true;
}

}  // namespace

Result<SplitQuery> split_query(std::string_view query) {
  SplitQuery split;
  std::optional<std::string_view> expires, signature;
  bool is_first = true;
  for (bool is_last = false; !is_last;) {
    const std::string_view piece = query.substr(0, query.find('&'));
    is_last = piece.size() == query.size();
    query.remove_prefix(std::min(query.size(), piece.size() + 1));
    const auto is_expires = taken(piece, "expires", expires);
    if (!is_expires) return is_expires.error();
    const auto is_signature = taken(piece, "signature", signature);
    if (!is_signature) return is_signature.error();
    if (*is_expires || *is_signature) continue;
    if (!is_first) split.rest.push_back('&');
    split.rest.append(piece);
    is_first = false;
  }
  if (expires || signature) {
    split.signature = UrlSignature{expires.value_or(""), signature.value_or("")};
  }
  return split;
}

std::string sign_query(std::string_view key, std::string_view id, std::uint64_t expires) {
  return "expires=" + std::to_string(expires) +
         "&signature=" + to_hex(signature_of(key, id, expires));
}

bool is_valid_signature(const UrlSignature& signature, std::string_view key, std::string_view id,
                        std::uint64_t now) {
  const auto expires = parse_whole<std::uint64_t>(signature.expires);
  if (!expires || *expires < now) return false;
  const std::string right = to_hex(signature_of(key, id, *expires));
  return signature.signature.size() == right.size() &&
         CRYPTO_memcmp(signature.signature.data(), right.data(), right.size()) == 0;
}

std::string hide_signatures(std::string_view target) {
  constexpr std::string_view kName = "signature=";
  const std::size_t begin = std::min(target.find('?'), target.size());
  std::string shown(target.substr(0, begin));
  std::string_view query = target.substr(begin);
  while (!query.empty()) {
    shown.push_back(query.front());  // '?' or '&'
    query.remove_prefix(1);
    const std::string_view piece = query.substr(0, query.find('&'));
    query.remove_prefix(piece.size());
    shown.append(piece.starts_with(kName) ? "signature=..." : piece);
  }
  return shown;
}

}  // namespace pmesh
