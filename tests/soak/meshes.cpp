#include "tests/soak/meshes.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "core/pm/verify.h"
#include "tests/fixtures/temporary_directory.h"

namespace pmesh::soak {
namespace {

SoakMesh read_mesh(const std::filesystem::path& path) {
  const std::string text = contents(path.string());
  SoakMesh mesh;
  mesh.id = path.stem().string();
  mesh.bytes.assign(text.begin(), text.end());
  const auto index = parse_prologue(mesh.bytes);
  if (!index || !*index) {
    std::fprintf(stderr, "%s is no PM file\n", path.c_str());
    std::exit(2);
  }
  mesh.index = **index;
  mesh.decodes = verify_file(path.string()).ok();
  return mesh;
}

}  // namespace

std::vector<SoakMesh> read_meshes(const std::string& directory) {
  std::vector<SoakMesh> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.path().extension() == ".pmesh") meshes.push_back(read_mesh(entry.path()));
  }
  return meshes;
}

LodRequest random_wish(Random& random, const FileIndex& index) {
  const std::uint64_t chunks = index.chunks.size();
  switch (below(random, chunks > 0 ? 6 : 5)) {
    case 0:
      return {};
    case 1:
      return {.kind = WishKind::faces, .count = 1 + below(random, 2 * index.header.faces)};
    case 2:
      return {.kind = WishKind::vertices, .count = 1 + below(random, 2 * index.header.vertices)};
    case 3:
      return {.kind = WishKind::ratio, .ratio = double(1 + below(random, 1000)) / 1000};
    case 4:
      return {.kind = WishKind::bytes, .count = below(random, 2 * index.header.file_bytes)};
    default: {
      const std::uint64_t first = below(random, chunks);
      return {.kind = WishKind::chunks,
              .first_chunk = first,
              .last_chunk = first + below(random, chunks - first)};
    }
  }
}

}  // namespace pmesh::soak
