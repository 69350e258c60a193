// The catalogue as it is sent: one text for all who ask, until the meshes change.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "core/base/bytes.h"
#include "server/store/mesh_store.h"

namespace pmesh {

struct Catalogue {
  Bytes json;
  std::string etag;  ///< With its quotes; the same for the same text, on every server.
};

/// Threads: get() may be called at the same time; who comes while the text is made waits for it.
class CatalogueCache {
 public:
  /// `store` outlives it.
  explicit CatalogueCache(MeshStore& store) : store_(store) {}

  /// The catalogue of the meshes as MeshStore::list() gives them; never null. Throws
  /// std::bad_alloc.
  std::shared_ptr<const Catalogue> get();

 private:
  MeshStore& store_;
  std::mutex mutex_;  // guards the two below
  std::uint64_t generation_ = 0;
  std::shared_ptr<const Catalogue> last_;  // of this generation, or a later one
};

}  // namespace pmesh
