#include "protocol/apply_wish.h"

namespace pmesh {
namespace {

// `covering_vertices`: after the chunks that the wish resolves to.
void move_to(const LodRequest& wish, const FileIndex& index, std::uint64_t covering_vertices,
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
      return mesh.set_vertices(covering_vertices);
  }
}

}  // namespace

Result<AppliedWish> apply_wish(const LodRequest& wish, const FileIndex& index,
                               RefinableMesh& mesh) {
  const Result<Resolution> resolution = resolve(wish, index);
  if (!resolution) return resolution.error();
  const std::uint64_t covering_vertices = index.vertices_after(resolution->chunk_count);
  move_to(wish, index, covering_vertices, mesh);
  return AppliedWish{mesh.face_count(), mesh.vertex_count(),
                     resolution->reached && mesh.known_vertices() >= covering_vertices};
}

}  // namespace pmesh
