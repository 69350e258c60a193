// Two chunks of splits on one of a few base meshes, where neither checksums nor Draco stand in the
// way. The input: a byte that chooses the base; the first chunk's splits, its bytes, and the second
// chunk's splits, 16 bits each; then the chunks.
#include <algorithm>
#include <cstdint>

#include "core/pm/split_decoder.h"
#include "tests/fixtures/random_chunks.h"
#include "tests/fuzz/require_sound.h"

namespace {

using namespace pmesh;

// No more splits than an index may claim for these bytes.
bool decode(SplitDecoder& decoder, ByteView chunk, std::uint32_t splits, const FileHeader& header,
            RefinableMesh& mesh) {
  const auto most = static_cast<std::uint32_t>(8 * chunk.size());
  const bool decoded = decoder.decode(chunk, std::min(splits, most), header, mesh).ok();
  require_sound(mesh, header.lattice.bits);
  return decoded;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<SplitBase> kBases = split_bases();
  ByteReader reader({data, size});
  const SplitBase& base = kBases[reader.get<std::uint8_t>() % kBases.size()];
  const auto first_splits = reader.get<std::uint16_t>();
  const auto first_bytes = reader.get<std::uint16_t>();
  const auto second_splits = reader.get<std::uint16_t>();
  const ByteView chunks = reader.take(reader.remaining());
  const ByteView first = chunks.first(std::min<std::size_t>(first_bytes, chunks.size()));

  RefinableMesh mesh = base.refinable();
  SplitDecoder decoder(mesh);
  if (decode(decoder, first, first_splits, base.header, mesh)) {
    decode(decoder, chunks.subspan(first.size()), second_splits, base.header, mesh);
  }
  return 0;
}
