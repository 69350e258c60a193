#include "client/apply_wish.h"

#include <algorithm>

namespace pmesh {
namespace {

// Splits applied once the base and `chunk_count` chunks are: every split adds one vertex.
std::uint64_t splits_after(const FileIndex& index, std::uint64_t chunk_count) {
  return index.vertices_after(chunk_count) - index.header.base_vertices;
}

void move_to(const LodRequest& wish, const FileIndex& index, std::uint64_t covering_splits,
             RefinableMesh& mesh) {
  switch (wish.kind) {
    case WishKind::everything:
      return mesh.set_finest();
    case WishKind::faces:
      return mesh.set_faces(wish.count);
    case WishKind::vertices:
      return mesh.set_vertices(wish.count);
    case WishKind::ratio:
      return mesh.set_faces(faces_of_ratio(wish.ratio, index));
    case WishKind::error:
    case WishKind::bytes:
    case WishKind::chunks:
      const std::uint64_t known = mesh.known_splits();
      return mesh.set_splits(static_cast<std::uint32_t>(std::min(covering_splits, known)));
  }
}

}  // namespace

Result<AppliedWish> apply_wish(const LodRequest& wish, const FileIndex& index,
                               RefinableMesh& mesh) {
  const Result<Resolution> resolution = resolve(wish, index);
  if (!resolution) return resolution.error();
  const std::uint64_t covering_splits = splits_after(index, resolution->chunk_count);
  move_to(wish, index, covering_splits, mesh);
  return AppliedWish{mesh.face_count(), mesh.vertex_count(),
                     resolution->reached && mesh.known_splits() >= covering_splits};
}

}  // namespace pmesh
