// The push parser behind its checksums, with cuts chosen by the input: the first byte says how the
// rest is cut. Cut and whole feeding must agree, what decodes must be a valid mesh on the lattice,
// and coarsening must be undone exactly.
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/pm/base_codec.h"
#include "core/pm/stream_decoder.h"

namespace {

pmesh::DecodeLimits limits() {
  pmesh::DecodeLimits limits;
  limits.max_faces = 1'000'000;
  limits.max_base_faces = 10'000;
  limits.verify_checksums = false;
  return limits;
}

void require(bool condition) {
  if (!condition) std::abort();
}

void require_same(const pmesh::LatticeMesh& a, const pmesh::LatticeMesh& b) {
  require(a.triangles == b.triangles && a.positions == b.positions);
}

void check_mesh(pmesh::RefinableMesh& mesh, int lattice_bits) {
  require(mesh.connectivity().validate().ok());
  for (const pmesh::Vec3i p : mesh.positions()) require((p.x | p.y | p.z) >> lattice_bits == 0);
  const pmesh::LatticeMesh finest = mesh.snapshot();
  mesh.set_splits(0);
  mesh.set_finest();
  require_same(mesh.snapshot(), finest);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t step = 1 + std::size_t{data[0]} * data[0];
  const pmesh::ByteView file(data + 1, size - 1);
  pmesh::StreamDecoder whole(pmesh::decode_base, limits());
  pmesh::StreamDecoder cut(pmesh::decode_base, limits());
  const bool whole_ok = whole.feed(file).ok();
  bool cut_ok = true;
  for (std::size_t at = 0; at < file.size() && cut_ok; at += step) {
    cut_ok = cut.feed(file.subspan(at, std::min(step, file.size() - at))).ok();
  }
  require(whole_ok == cut_ok && whole.chunk_count() == cut.chunk_count());
  if (whole.has_base()) {
    require_same(whole.mesh().snapshot(), cut.mesh().snapshot());
    check_mesh(whole.mesh(), whole.index().header.lattice.bits);
  }
  return 0;
}
