// What a reload of the configuration may change while the server runs.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "core/base/result.h"
#include "server/access/access_policy.h"
#include "server/net/tls.h"
#include "server/options.h"

namespace pmesh {

/// Threads: immutable.
struct Policy {
  SessionLimits limits;
  AccessPolicy access;
  std::shared_ptr<const TlsContext> tls;  ///< Null: no TLS.
  bool access_log = false;
};
using PolicyPtr = std::shared_ptr<const Policy>;

/// Reads the certificate's files. Fails (usage) if they make no sense, or if only one is named.
Result<PolicyPtr> make_policy(const ServerOptions& options);

/// The policy that stands. Threads: all members may be called at the same time.
class CurrentPolicy {
 public:
  /// Precondition of both: not null.
  explicit CurrentPolicy(PolicyPtr policy) : policy_(std::move(policy)) {}
  void set(PolicyPtr policy) {
    const std::lock_guard lock(mutex_);
    policy_ = std::move(policy);
    version_.fetch_add(1, std::memory_order_release);
  }
  /// Another one after each set(): whoever holds a policy need not ask while this stays.
  std::uint64_t version() const { return version_.load(std::memory_order_acquire); }

  PolicyPtr get() const {
    const std::lock_guard lock(mutex_);
    return policy_;
  }

 private:
  mutable std::mutex mutex_;
  PolicyPtr policy_;
  std::atomic<std::uint64_t> version_ = 0;
};

}  // namespace pmesh
