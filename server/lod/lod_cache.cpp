#include "server/lod/lod_cache.h"

#include <cassert>

namespace pmesh {

LodFilePtr LodCache::find(const LodKey& key) {
  const auto found = places_.find(key);
  if (found == places_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->second;
}

void LodCache::put(const LodKey& key, LodFilePtr file) {
  assert(!places_.contains(key));
  const std::size_t size = file->bytes.size();
  if (size > most_bytes_) return;
  while (bytes_ + size > most_bytes_) {
    bytes_ -= entries_.back().second->bytes.size();
    places_.erase(entries_.back().first);
    entries_.pop_back();
  }
  entries_.emplace_front(key, std::move(file));
  try {
    places_.emplace(key, entries_.begin());
  } catch (...) {  // for want of memory: then it is not kept
    entries_.pop_front();
    throw;
  }
  bytes_ += size;
}

}  // namespace pmesh
