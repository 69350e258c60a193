// The push parser behind its checksums, with cuts chosen by the input: the first byte says how the
// rest is cut. Cut and whole feeding must agree, what decodes must be a valid mesh on the lattice,
// and coarsening must be undone exactly.
#include <algorithm>
#include <cstdint>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"
#include "tests/fuzz/require_sound.h"

namespace {

using namespace pmesh;

DecodeLimits limits() {
  DecodeLimits limits;
  limits.max_faces = 1'000'000;
  limits.max_base_faces = 10'000;
  limits.verify_checksums = false;
  return limits;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t step = 1 + std::size_t{data[0]} * data[0];
  const ByteView file(data + 1, size - 1);
  StreamDecoder whole(decode_base, limits());
  StreamDecoder cut(decode_base, limits());
  const bool whole_ok = whole.feed(file).ok();
  bool cut_ok = true;
  for (std::size_t at = 0; at < file.size() && cut_ok; at += step) {
    cut_ok = cut.feed(file.subspan(at, std::min(step, file.size() - at))).ok();
  }
  require(whole_ok == cut_ok && whole.chunk_count() == cut.chunk_count());
  if (whole.has_base()) {
    require_same(whole.mesh().snapshot(), cut.mesh().snapshot());
    require_sound(whole.mesh(), whole.index().header.lattice.bits);
  }
  return 0;
}
