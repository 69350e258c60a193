#include "core/pm/split_decoder.h"

#include <string>

#include "core/pm/chunk_reader.h"
#include "core/pm/split_coder.h"

namespace pmesh {

Status SplitDecoder::decode(ByteView chunk, std::uint32_t split_count, const FileHeader& header,
                            RefinableMesh& mesh) {
  state_.grow(mesh);
  if (split_count == 0) {
    return chunk.empty() ? Status() : bad_input("bytes follow the new components");
  }
  ChunkReader reader(chunk);
  SplitCoder<ChunkReader> coder(reader, header, model_, mesh, state_);
  for (std::uint32_t done = 0; done < split_count;) {
    Status decoded = coder.code(batch_, split_count - done);
    if (decoded.ok()) decoded = state_.apply(batch_, mesh);
    if (!decoded) return prefixed("batch after split " + std::to_string(done), decoded.error());
    done += static_cast<std::uint32_t>(batch_.size());
  }
  return reader.at_end() ? Status() : bad_input("bytes follow the chunk's last split");
}

}  // namespace pmesh
