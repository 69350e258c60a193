// Who may read what (docs/protocol.md, 2.8): everybody, or who has a bearer token, or a URL signed
// for one mesh and some time. Judges a request without knowing routes or sockets.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/access/signed_query.h"
#include "server/options.h"

namespace pmesh {

/// What a request brings along. The views belong to whoever parsed it.
struct AccessRequest {
  std::string_view authorization{};  ///< The field's value; empty if there is none.
  std::optional<UrlSignature> signature{};
  /// The decoded id of the mesh that is asked for; empty if it is none, such as for the catalogue,
  /// which no signature opens.
  std::string_view mesh_id{};
  std::uint64_t now = 0;  ///< Unix time in seconds.
};

enum class Access : std::uint8_t {
  granted,
  unauthenticated,  ///< No token or a wrong one, and no signature: 401 with kChallenge.
  forbidden,        ///< A signature that is expired, wrong or for another mesh: 403.
};

/// The value of WWW-Authenticate in a 401.
inline constexpr std::string_view kChallenge = "Bearer realm=\"pmesh\"";

/// Threads: immutable.
class AccessPolicy {
 public:
  explicit AccessPolicy(const AccessOptions& options);

  /// True if everything is granted. If not, answers are for their client alone, and must not be
  /// `public` to caches.
  bool is_public() const { return token_digests_.empty() && url_key_.empty(); }

  /// A right token is enough, and so is a right signature. Compares in constant time.
  Access judge(const AccessRequest& request) const;

 private:
  using Digest = std::array<std::uint8_t, 32>;
  static Digest digest_of(std::string_view token);
  bool knows_token(std::string_view authorization) const;

  std::vector<Digest> token_digests_;
  std::string url_key_;
};

}  // namespace pmesh
