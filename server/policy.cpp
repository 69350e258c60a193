#include "server/policy.h"

namespace pmesh {

Result<PolicyPtr> make_policy(const ServerOptions& options) {
  auto policy = std::make_shared<Policy>(
      Policy{options.limits, AccessPolicy(options.access), nullptr, options.access_log});
  const TlsOptions& tls = options.tls;
  if (tls.certificate.empty() != tls.key.empty()) {
    return Error{ErrorCode::usage, "TLS needs both a certificate and its key"};
  }
  if (!tls.certificate.empty()) {
    const auto context = TlsContext::load(tls);
    if (!context) return context.error();
    policy->tls = *context;
  }
  return PolicyPtr(std::move(policy));
}

}  // namespace pmesh
