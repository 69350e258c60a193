// All that answers need besides a request, over a directory of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/http_answer.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh::testing {

/// Files that change are seen at once.
class HttpSite {
 public:
  const TemporaryDirectory& directory() const { return directory_; }
  void set_access(const AccessOptions& options) { access_ = AccessPolicy(options); }

  HttpContext context() {
    return {.store = *store_,
            .catalogue = catalogue_,
            .access = access_,
            .limits = limits,
            .most_lod_faces = most_lod_faces,
            .now = now,
            .metrics_text = metrics_text};
  }

  SessionLimits limits;
  std::uint64_t most_lod_faces = 1'000'000;
  std::uint64_t now = 1'000'000'000;
  std::function<std::string()> metrics_text = [] { return "metrics"; };

 private:
  TemporaryDirectory directory_;
  AccessPolicy access_{AccessOptions{}};
  std::unique_ptr<MeshStore> store_ =
      MeshStore::open(directory_ / "", std::chrono::milliseconds(0), std::chrono::milliseconds(0))
          .value();
  CatalogueCache catalogue_{*store_};
};

}  // namespace pmesh::testing
