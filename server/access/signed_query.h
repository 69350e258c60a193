// The signature in the query of a signed URL (docs/protocol.md, 2.8).
//
// Threads: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace pmesh {

/// The two members as they stand in the query, not judged yet.
struct UrlSignature {
  std::string_view expires;
  std::string_view signature;
};

struct SplitQuery {
  std::optional<UrlSignature> signature;  ///< Nothing if neither member is there.
  std::string rest;                       ///< The query without them: the wish.
};

/// Takes `expires` and `signature` out of a query without its '?', wherever they stand. The views
/// point into `query`. Fails (usage) if one of them comes twice. Never looks at the rest.
Result<SplitQuery> split_query(std::string_view query);

/// `target` with "..." for the value of every `signature` in its query: for logs, whose readers
/// must not get access by them.
std::string hide_signatures(std::string_view target);

/// "expires=UNIX&signature=HEX" for the mesh `id` up to and including the second `expires` (Unix
/// time).
std::string sign_query(std::string_view key, std::string_view id, std::uint64_t expires);

/// Whether `signature` is that of `id` by `key` and not past `now` (Unix time). Takes the same time
/// wherever a wrong signature differs.
bool is_valid_signature(const UrlSignature& signature, std::string_view key, std::string_view id,
                        std::uint64_t now);

}  // namespace pmesh
