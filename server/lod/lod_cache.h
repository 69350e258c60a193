// Finished levels of detail kept in memory, up to a number of bytes.
#pragma once

#include <compare>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "core/pm/format.h"
#include "protocol/lod_format.h"
#include "server/lod/lod_export.h"

namespace pmesh {

using LodFilePtr = std::shared_ptr<const LodFile>;

/// What makes two levels of detail the same file.
struct LodKey {
  ContentHash hash{};
  LodFormat format{};
  std::string wish;  ///< canonical_wish() as text.
  bool reached = true;

  friend auto operator<=>(const LodKey&, const LodKey&) = default;
};

/// Drops what was asked for least recently first. Threads: one at a time.
class LodCache {
 public:
  explicit LodCache(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Null if it is not kept.
  LodFilePtr find(const LodKey& key);

  /// A file larger than all that may be kept is not kept. Precondition: `key` is not there.
  void put(const LodKey& key, LodFilePtr file);

  std::size_t bytes() const { return bytes_; }  ///< Of all files kept.

 private:
  using Entry = std::pair<LodKey, LodFilePtr>;

  const std::size_t most_bytes_;
  std::list<Entry> entries_;  // asked for last comes first
  std::map<LodKey, std::list<Entry>::iterator> places_;
  std::size_t bytes_ = 0;
};

}  // namespace pmesh
