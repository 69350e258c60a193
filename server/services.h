// What the sessions of one server share.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "server/http/catalogue_cache.h"
#include "server/lod/lod_service.h"
#include "server/metrics/metrics.h"
#include "server/net/address_block.h"
#include "server/net/address_counts.h"
#include "server/policy.h"
#include "server/store/mesh_store.h"

namespace pmesh {

/// All of it outlives the sessions. Threads: as the members say, which is any.
struct Services {
  MeshStore& store;
  CatalogueCache& catalogue;
  LodService& lod;
  Metrics& metrics;
  AddressCounts& addresses;
  const TrustedProxies& proxies;
  const CurrentPolicy& policy;
  const std::uint64_t most_lod_faces;
  const std::function<std::string()> metrics_text;  ///< Empty: not served with HTTP.
  const bool only_operation = false;                ///< Serve nothing but metrics and health.
};

}  // namespace pmesh
