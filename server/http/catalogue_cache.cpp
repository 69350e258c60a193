#include "server/http/catalogue_cache.h"

#include <vector>

#include "core/pm/digest.h"
#include "protocol/catalogue_json.h"

namespace pmesh {
namespace {

Catalogue make_catalogue(const std::vector<MeshPtr>& meshes) {
  std::vector<CatalogueEntry> entries;
  for (const MeshPtr& mesh : meshes) entries.push_back({mesh->id(), &mesh->index()});
  const std::string text = catalogue_json(entries);
  const ByteView json = as_bytes(text);
  std::string etag = "\"";
  etag.append(to_hex(digest_section(json))).append("\"");
  return {Bytes(json.begin(), json.end()), std::move(etag)};
}

}  // namespace

std::shared_ptr<const Catalogue> CatalogueCache::get() {
  const std::uint64_t generation = store_.generation();
  const std::lock_guard lock(mutex_);
  if (!last_ || generation_ < generation) {
    last_ = std::make_shared<const Catalogue>(make_catalogue(store_.list()));
    generation_ = generation;
  }
  return last_;
}

}  // namespace pmesh
