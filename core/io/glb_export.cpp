#include "core/io/glb_export.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/base/box.h"
#include "core/io/draco_export.h"
#include "core/io/single_precision.h"

namespace pmesh {
namespace {

using Json = nlohmann::ordered_json;

// glTF's numbers for things.
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;
constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kFileHeaderBytes = 12, kChunkHeaderBytes = 8;

template <class T>
Json vector_json(Vec3<T> v) {
  return Json::array({double{v.x}, double{v.y}, double{v.z}});
}

/// Where the vertices lie: on `lattice`, then moved by the node.
struct Placement {
  Lattice lattice;
  Json node;
};

Placement place(const Lattice& lattice) {
  if (fits_single_precision(lattice)) return {lattice, {{"mesh", 0}}};
  const std::int32_t middle = 1 << (lattice.bits - 1);
  const double low = -middle;
  return {{.origin = {low, low, low}, .step = 1, .bits = lattice.bits},
          {{"mesh", 0},
           {"translation", vector_json(lattice.position({middle, middle, middle}))},
           {"scale", Json::array({lattice.step, lattice.step, lattice.step})}}};
}

std::vector<Vec3<float>> to_floats(const LatticeMesh& mesh, const Lattice& lattice) {
  std::vector<Vec3<float>> positions(mesh.positions.size());
  std::ranges::transform(mesh.positions, positions.begin(),
                         [&](Vec3i point) { return to_single(lattice.position(point)); });
  return positions;
}

/// The buffer's bytes as they grow, and what tells a reader what they are.
struct Gltf {
  explicit Gltf(const Placement& placement);
  Gltf(const Gltf&) = delete;
  Gltf& operator=(const Gltf&) = delete;

  Json json;
  Bytes buffer;
};

Gltf::Gltf(const Placement& placement)
    : json({{"asset", {{"version", "2.0"}, {"generator", "pmesh"}}},
            {"scene", 0},
            {"scenes", Json::array({{{"nodes", {0}}}})},
            {"nodes", Json::array({placement.node})},
            {"materials", Json::array({{{"pbrMetallicRoughness",
                                         {{"baseColorFactor", {0.8, 0.8, 0.8, 1}},
                                          {"metallicFactor", 0},
                                          {"roughnessFactor", 0.8}}},
                                        {"doubleSided", true}}})}}) {}

Json positions_accessor(const Box<float>& box, std::size_t count) {
  return {{"componentType", kFloat},
          {"count", count},
          {"type", "VEC3"},
          {"min", vector_json(box.low)},
          {"max", vector_json(box.high)}};
}

Json indices_accessor(int component_type, std::size_t count) {
  return {{"componentType", component_type}, {"count", count}, {"type", "SCALAR"}};
}

/// 65535 itself is no index: some graphics interfaces restart a primitive there.
int index_type(std::size_t vertices) { return vertices <= 65535 ? kUnsignedShort : kUnsignedInt; }

void set_mesh(Gltf& gltf, Json positions, Json indices, Json extensions) {
  gltf.json["accessors"] = Json::array({std::move(positions), std::move(indices)});
  Json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}};
  if (!extensions.is_null()) primitive["extensions"] = std::move(extensions);
  gltf.json["meshes"] = Json::array({{{"primitives", Json::array({std::move(primitive)})}}});
}

void put_indices(Bytes& buffer, const std::vector<Triangle>& triangles, int type) {
  ByteWriter writer(buffer);
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t corner : triangle) {
      if (type == kUnsignedShort) {
        writer.put(static_cast<std::uint16_t>(corner));
      } else {
        writer.put(corner);
      }
    }
  }
}

void add_accessors(Gltf& gltf, const LatticeMesh& mesh, const Lattice& lattice) {
  const std::vector<Vec3<float>> points = to_floats(mesh, lattice);
  const int type = index_type(points.size());
  const std::size_t corners = 3 * mesh.triangles.size();
  const std::size_t position_bytes = sizeof(Vec3<float>) * points.size();
  const std::size_t index_bytes = (type == kUnsignedShort ? 2 : 4) * corners;
  gltf.buffer.reserve(position_bytes + index_bytes);
  ByteWriter writer(gltf.buffer);
  for (const Vec3<float> p : points) {
    for (const float c : {p.x, p.y, p.z}) writer.put(std::bit_cast<std::uint32_t>(c));
  }
  put_indices(gltf.buffer, mesh.triangles, type);

  gltf.json["bufferViews"] =
      Json::array({{{"buffer", 0}, {"byteLength", position_bytes}, {"target", kVertexBuffer}},
                   {{"buffer", 0},
                    {"byteOffset", position_bytes},
                    {"byteLength", index_bytes},
                    {"target", kIndexBuffer}}});
  Json positions =
      positions_accessor(bounding_box(std::span(std::as_const(points))), points.size());
  Json indices = indices_accessor(type, corners);
  positions["bufferView"] = 0;
  indices["bufferView"] = 1;
  set_mesh(gltf, std::move(positions), std::move(indices), nullptr);
}

/// The accessors have no bytes of their own: they say what the extension's bytes come to.
Status add_draco(Gltf& gltf, const LatticeMesh& mesh, const Lattice& lattice) {
  Result<DracoExport> coded = export_draco(mesh, lattice, DracoNumbers::floats);
  if (!coded) return coded.error();
  gltf.buffer = std::move(coded->bytes);
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = Json::array({kDracoExtension});
  gltf.json["bufferViews"] = Json::array({{{"buffer", 0}, {"byteLength", gltf.buffer.size()}}});
  const std::vector<Vec3<float>> points = to_floats(mesh, lattice);
  set_mesh(
      gltf, positions_accessor(bounding_box(std::span(std::as_const(points))), coded->vertices),
      indices_accessor(index_type(coded->vertices), std::size_t{3} * coded->faces),
      {{kDracoExtension, {{"bufferView", 0}, {"attributes", {{"POSITION", kDracoPositionId}}}}}});
  return {};
}

/// Fills the last word of a chunk.
template <class Container>
void pad(Container& bytes, char filler) {
  while (bytes.size() % 4 != 0)
    bytes.push_back(static_cast<typename Container::value_type>(filler));
}

Result<Bytes> finish(Gltf& gltf) {
  gltf.json["buffers"] = Json::array({{{"byteLength", gltf.buffer.size()}}});
  std::string json = gltf.json.dump();
  pad(json, ' ');
  pad(gltf.buffer, '\0');
  const std::size_t total =
      kFileHeaderBytes + 2 * kChunkHeaderBytes + json.size() + gltf.buffer.size();
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return Error{ErrorCode::out_of_resources, "the mesh needs more than the 4 GiB of a GLB"};
  }
  Bytes out;
  out.reserve(total);
  ByteWriter writer(out);
  const auto put_word = [&](std::size_t word) { writer.put(static_cast<std::uint32_t>(word)); };
  for (const std::size_t word : {std::size_t{kMagic}, std::size_t{2}, total}) put_word(word);
  put_word(json.size());
  put_word(kJsonChunk);
  writer.put(as_bytes(json));
  put_word(gltf.buffer.size());
  put_word(kBinaryChunk);
  writer.put(ByteView(gltf.buffer));
  return out;
}

}  // namespace

Result<Bytes> format_glb(const LatticeMesh& mesh, const Lattice& lattice, GlbGeometry geometry) {
  assert(!mesh.triangles.empty());
  const Placement placement = place(lattice);
  Gltf gltf(placement);
  if (geometry == GlbGeometry::accessors) {
    add_accessors(gltf, mesh, placement.lattice);
  } else if (Status added = add_draco(gltf, mesh, placement.lattice); !added) {
    return added.error();
  }
  return finish(gltf);
}

}  // namespace pmesh
