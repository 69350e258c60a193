// The meshes that are served, as this program knows them, and random wishes for them.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/pm/format.h"
#include "protocol/lod_request.h"

namespace pmesh::soak {

using Random = std::mt19937_64;

/// A number from 0 to `bound` - 1.
inline std::uint64_t below(Random& random, std::uint64_t bound) { return random() % bound; }
/// True once in `times` calls.
inline bool once_in(Random& random, std::uint64_t times) { return below(random, times) == 0; }

struct SoakMesh {
  std::string id;
  Bytes bytes;
  FileIndex index;
  bool decodes = false;  ///< Finished levels of it can be made.

  std::string_view text(std::uint64_t begin, std::uint64_t end) const {
    return {reinterpret_cast<const char*>(bytes.data()) + begin,
            static_cast<std::size_t>(end - begin)};
  }
};

/// All PM files of a directory. Ends the program if one is none.
std::vector<SoakMesh> read_meshes(const std::string& directory);

/// A wish that the mesh can be asked for.
LodRequest random_wish(Random& random, const FileIndex& index);

}  // namespace pmesh::soak
