#include "core/pm/mesh_section.h"

namespace pmesh {

Result<LatticeMesh> decode_mesh(BaseDecoder decode, ByteView bytes, const MeshCounts& counts,
                                const Lattice& lattice) {
  Result<LatticeMesh> mesh = decode(bytes, counts);
  if (!mesh) return mesh.error();
  if (MeshCounts{mesh->positions.size(), mesh->triangles.size()} != counts) {
    return damaged("its counts differ from the header's");
  }
  for (const Vec3i p : mesh->positions) {
    if (((p.x | p.y | p.z) >> lattice.bits) != 0) return damaged("a vertex lies off the lattice");
  }
  return mesh;
}

Result<ChunkParts> chunk_parts(ByteView chunk, const ChunkRow& row) {
  if (row.arrivals.faces == 0) return ChunkParts{{}, chunk};
  ByteReader reader(chunk);
  const ByteView components = reader.take(reader.get<std::uint32_t>());
  if (reader.failed()) return bad_input("its new components overrun it");
  if (row.arrivals.faces > kMaxBaseFacesPerByte * components.size()) {
    return bad_input("its new components' bytes do not fit their faces");
  }
  return ChunkParts{components, chunk.subspan(reader.position())};
}

Bytes write_components(ByteView components) {
  Bytes bytes;
  bytes.reserve(sizeof(std::uint32_t) + components.size());
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint32_t>(components.size()));
  writer.put(components);
  return bytes;
}

}  // namespace pmesh
