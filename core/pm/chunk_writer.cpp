#include "core/pm/chunk_writer.h"

#include <algorithm>

namespace pmesh {

Bytes ChunkWriter::finish(std::size_t least) && {
  // Of the codes in [low, low + range) one after which, from some bit on, any bits may follow.
  int free_bits = 47;
  for (;; --free_bits) {
    const std::uint64_t block = std::uint64_t{1} << free_bits;
    const std::uint64_t code = (low_ + block - 1) & ~(block - 1);
    if (code + block > low_ + range_) continue;
    low_ = code;
    break;
  }
  for (int unit = 0; unit < 3; ++unit) put_unit();
  front_.resize(front_.size() - static_cast<std::size_t>(free_bits / 8));
  const Bytes back = std::move(raw_).finish();
  Bytes chunk = std::move(front_);
  chunk.resize(std::max(chunk.size(), least - std::min(least, back.size())));
  chunk.insert(chunk.end(), back.rbegin(), back.rend());
  return chunk;
}

}  // namespace pmesh
