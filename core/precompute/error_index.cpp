#include "core/precompute/error_index.h"

#include <algorithm>
#include <cassert>

#include "core/io/export.h"
#include "core/measure/level_errors.h"
#include "core/pm/base_codec.h"
#include "core/pm/digest.h"
#include "core/pm/stream_decoder.h"

namespace pmesh {
namespace {

// The LOD that stands, with positions as exported.
IndexedMesh exported(const RefinableMesh& mesh, const Lattice& lattice) {
  const bool single = fits_single_precision(lattice);
  LatticeMesh lod = mesh.snapshot();
  IndexedMesh result{{}, std::move(lod.triangles)};
  result.positions.reserve(lod.positions.size());
  for (const Vec3i point : lod.positions) {
    Vec3d p = lattice.position(point);
    if (single) p = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    result.positions.push_back(p);
  }
  return result;
}

}  // namespace

std::uint32_t largest_valence(const IndexedMesh& mesh) {
  std::vector<std::uint32_t> faces(mesh.positions.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) ++faces[v];
  }
  return faces.empty() ? 0 : *std::max_element(faces.begin(), faces.end());
}

Status write_error_index(Bytes& file, const IndexedMesh& original, unsigned threads,
                         const std::function<void(double)>& progress) {
  Result<LevelErrors> errors =
      LevelErrors::of({original.positions, original.triangles}, {.threads = threads});
  if (!errors) return errors.error();
  FileIndex index = **parse_prologue(file);
  StreamDecoder decoder(decode_base);
  const ByteView bytes(file);
  std::uint64_t fed = 0;
  for (std::size_t c = 0; c < index.chunks.size(); ++c) {
    progress(static_cast<double>(c) / static_cast<double>(index.chunks.size()));
    ChunkRow& row = index.chunks[c];
    if (Status status = decoder.feed(bytes.subspan(fed, row.end() - fed)); !status) return status;
    fed = row.end();
    const IndexedMesh lod = exported(decoder.mesh(), index.header.lattice);
    const LevelError error = errors->measure({lod.positions, lod.triangles});
    row.max_error = error.max_error;
    row.rms_error = error.rms_error;
  }
  index.header.errors_measured = true;
  const Bytes prologue = write_hashed_prologue(index);
  assert(prologue.size() == index.prologue_bytes);
  std::copy(prologue.begin(), prologue.end(), file.begin());
  return {};
}

}  // namespace pmesh
