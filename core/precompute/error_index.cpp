#include "core/precompute/error_index.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "core/measure/level_errors.h"
#include "core/parallel/for_blocks.h"
#include "core/pm/base_codec.h"
#include "core/pm/digest.h"
#include "core/pm/stream_decoder.h"
#include "core/precompute/error_walk.h"

namespace pmesh {
namespace {

// The LOD that stands, with positions as exported.
IndexedMesh exported(const RefinableMesh& mesh, const Lattice& lattice, unsigned threads) {
  const ExportedPositions positions(lattice);
  LatticeMesh lod = mesh.snapshot();
  IndexedMesh result{std::vector<Vec3d>(lod.positions.size()), std::move(lod.triangles)};
  for_each_index(lod.positions.size(), threads,
                 [&](std::uint32_t v) { result.positions[v] = positions(lod.positions[v]); });
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
  const MeshView view{original.positions, original.triangles};
  const Result<UnitFrame> frame = unit_frame(box_of_faces(view));
  if (!frame) return frame.error();
  StreamDecoder decoder(decode_base);
  Status decoded;
  std::optional<ErrorWalk> walk;
  std::optional<LevelErrors> errors;
  run_both(
      threads,
      [&] {
        decoded = decoder.feed(file);
        if (decoded) walk.emplace(decoder.mesh(), decoder.index().header.lattice, original, *frame);
      },
      [&] { errors.emplace(view, *frame, LevelErrorOptions{.threads = threads}); });
  if (!decoded) return decoded;

  FileIndex index = decoder.index();
  for (std::size_t c = index.chunks.size(); c-- > 0;) {
    ChunkRow& row = index.chunks[c];
    walk->coarsen_to(static_cast<std::uint32_t>(row.vertices - index.header.base_vertices));
    const IndexedMesh lod = exported(decoder.mesh(), index.header.lattice, threads);
    const LevelError error = errors->measure(
        {lod.positions, lod.triangles, &decoder.mesh().connectivity()}, walk->errors());
    row.max_error = error.max_error;
    row.rms_error = error.rms_error;
    progress(1 - static_cast<double>(c) / static_cast<double>(index.chunks.size()));
  }
  index.header.errors_measured = true;
  const Bytes prologue = write_hashed_prologue(index);
  assert(prologue.size() == index.prologue_bytes);
  std::copy(prologue.begin(), prologue.end(), file.begin());
  return {};
}

}  // namespace pmesh
