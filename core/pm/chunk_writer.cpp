#include "core/pm/chunk_writer.h"

#include <algorithm>

namespace pmesh {

Bytes ChunkWriter::finish(std::size_t least) && {
  for (int unit = 0; unit < 3; ++unit) put_unit();
  const Bytes back = std::move(raw_).finish();
  Bytes chunk = std::move(front_);
  chunk.resize(std::max(chunk.size(), least - std::min(least, back.size())));
  chunk.insert(chunk.end(), back.rbegin(), back.rend());
  return chunk;
}

}  // namespace pmesh
