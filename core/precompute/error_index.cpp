#include "core/precompute/error_index.h"

#include <algorithm>
#include <array>
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
struct Level {
  IndexedMesh mesh;
  std::vector<std::array<std::uint32_t, 3>> neighbours;

  MeshView view() const { return {mesh.positions, mesh.triangles, neighbours}; }
};

Level exported(const RefinableMesh& mesh, const Lattice& lattice, unsigned threads) {
  const ExportedPositions positions(lattice);
  LatticeMesh lod = mesh.snapshot();
  Level level{{std::vector<Vec3d>(lod.positions.size()), std::move(lod.triangles)},
              std::vector<std::array<std::uint32_t, 3>>(mesh.face_count())};
  for_each_index(lod.positions.size(), threads,
                 [&](std::uint32_t v) { level.mesh.positions[v] = positions(lod.positions[v]); });
  for_each_index(mesh.face_count(), threads, [&](std::uint32_t face) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const HalfEdgeId twin = mesh.connectivity().twin(HalfEdgeId(3 * face + k));
      level.neighbours[face][k] = twin.valid() ? HalfEdgeMesh::face(twin).value : kNoIndex;
    }
  });
  return level;
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
  const auto plan = [&](std::size_t c) { walk->plan_to(index.chunks[c].vertices); };
  if (!index.chunks.empty()) plan(index.chunks.size() - 1);
  for (std::size_t c = index.chunks.size(); c-- > 0;) {
    walk->follow();
    const Level level = exported(decoder.mesh(), index.header.lattice, threads);
    LevelError error;
    run_both(
        threads, [&] { error = errors->measure(level.view(), walk->errors()); },
        [&] {
          if (c > 0) plan(c - 1);
        });
    index.chunks[c].max_error = error.max_error;
    index.chunks[c].rms_error = error.rms_error;
    progress(1 - static_cast<double>(c) / static_cast<double>(index.chunks.size()));
  }
  index.header.errors_measured = true;
  const Bytes prologue = write_hashed_prologue(index);
  assert(prologue.size() == index.prologue_bytes);
  std::copy(prologue.begin(), prologue.end(), file.begin());
  return {};
}

}  // namespace pmesh
