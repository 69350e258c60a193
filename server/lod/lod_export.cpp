#include "server/lod/lod_export.h"

#include <string>
#include <utility>

#include "core/files/out_of_memory.h"
#include "core/io/export.h"
#include "protocol/apply_wish.h"

namespace pmesh {
namespace {

ExportFormat export_format(LodFormat format) {
  switch (format) {
    case LodFormat::glb:
      return ExportFormat::glb;
    case LodFormat::glb_draco:
      return ExportFormat::glb_draco;
    case LodFormat::ply:
      return ExportFormat::ply;
    case LodFormat::obj:
      return ExportFormat::obj;
    case LodFormat::drc:
      break;
  }
  return ExportFormat::drc;
}

/// Whether `resolution` lies in the middle of a chunk in which some splits add one face only.
bool inside_border_chunk(const Resolution& resolution, const FileIndex& index) {
  const auto chunks = static_cast<std::size_t>(resolution.chunk_count);
  if (resolution.vertices == index.vertices_after(chunks)) return false;
  const MeshCounts added = index.added_by_splits(chunks - 1);
  return added.faces != 2 * added.vertices;
}

struct Level {
  LatticeMesh mesh;
  AppliedWish applied;
};

// On its own, so that all that was decoded on the way is gone before the level is written.
Result<Level> decode_level(const MeshFile& mesh, const LodRequest& wish,
                           const Resolution& resolution) {
  Result<RefinableMesh> decoded = mesh.decode(static_cast<std::size_t>(resolution.chunk_count));
  if (!decoded) return decoded.error();
  const Result<AppliedWish> applied = apply_wish(wish, mesh.index(), *decoded);
  if (!applied) return applied.error();
  return Level{decoded->snapshot(), *applied};
}

Result<LodFile> make_lod(const MeshFile& mesh, const LodRequest& wish, const Resolution& resolution,
                         LodFormat format) {
  const Result<Level> level = decode_level(mesh, wish, resolution);
  if (!level) return level.error();
  Result<Bytes> bytes =
      format_mesh(export_format(format), level->mesh, mesh.index().header.lattice);
  if (!bytes) return bytes.error();
  const AppliedWish& applied = level->applied;
  return LodFile{std::move(*bytes), applied.faces, applied.vertices, applied.reached};
}

}  // namespace

Result<Resolution> resolve_lod(const LodRequest& wish, const FileIndex& index,
                               std::uint64_t most_faces) {
  if (wish.kind == WishKind::chunks && wish.first_chunk > 0) {
    return usage_error("wish chunks: a finished mesh begins with chunk 0");
  }
  Result<Resolution> resolution = resolve(wish, index);
  if (resolution && resolution->faces > most_faces) {
    return usage_error("the wish comes to " + std::to_string(resolution->faces) +
                       " faces; finished meshes are made of at most " + std::to_string(most_faces));
  }
  return resolution;
}

LodRequest canonical_wish(const LodRequest& wish, const Resolution& resolution,
                          const FileIndex& index) {
  const bool counts_faces = wish.kind == WishKind::faces || wish.kind == WishKind::ratio;
  if (counts_faces && inside_border_chunk(resolution, index)) {
    const std::uint64_t faces =
        wish.kind == WishKind::faces ? wish.count : faces_of_ratio(wish.ratio, index);
    return {.kind = WishKind::faces, .count = faces};
  }
  return {.kind = WishKind::vertices, .count = resolution.vertices};
}

Result<LodFile> export_lod(const MeshFile& mesh, const LodRequest& wish, LodFormat format,
                           std::uint64_t most_faces) {
  const Result<Resolution> resolution = resolve_lod(wish, mesh.index(), most_faces);
  if (!resolution) return resolution.error();
  Result<LodFile> lod =
      catching_out_of_memory([&] { return make_lod(mesh, wish, *resolution, format); });
  if (!mesh.intact()) return runtime_error(mesh.id() + ": the file was changed");
  return lod;
}

}  // namespace pmesh
