#include "core/pm/base_codec.h"

#include <algorithm>
#include <memory>
#include <new>
#include <string>

#include <draco/attributes/point_attribute.h>
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include "core/draco/encode.h"

namespace pmesh {
namespace {

constexpr int kBestCompression = 0;  // Draco's "speed"

Result<Bytes> encode(const std::vector<Vec3i>& positions, const std::vector<Triangle>& triangles,
                     int method) {
  const auto mesh = make_draco_mesh(positions, triangles);
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetSpeedOptions(kBestCompression, kBestCompression);
  encoder.SetEncodingMethod(method);
  return run_draco(encoder);
}

Result<std::unique_ptr<draco::Mesh>> decode(ByteView bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return bad_input("Draco: " + decoded.status().error_msg_string());
  return std::move(decoded).value();
}

Result<LatticeMesh> from_draco(const draco::Mesh& mesh) {
  const draco::PointAttribute* const attribute =
      mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (mesh.num_attributes() != 1 || attribute == nullptr || attribute->num_components() != 3 ||
      attribute->data_type() != draco::DT_INT32) {
    return bad_input("Draco: not one attribute of three 32-bit integers");
  }
  LatticeMesh base;
  base.positions.resize(mesh.num_points());
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex index = attribute->mapped_index(p);
    if (index.value() >= attribute->size()) return bad_input("Draco: a vertex has no position");
    attribute->GetValue(index, &base.positions[p.value()]);
  }
  base.triangles.reserve(mesh.num_faces());
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(f);
    base.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return base;
}

// Rotated so that the smallest index comes first.
Triangle normalised(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) t = normalised(t);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Whether `coded.decoded` is `base` with its vertices renamed by decoded_vertex.
bool is_renaming(const LatticeMesh& base, const EncodedBase& coded) {
  const LatticeMesh& decoded = coded.decoded;
  if (decoded.positions.size() != base.positions.size() ||
      decoded.triangles.size() != base.triangles.size()) {
    return false;
  }
  for (std::size_t v = 0; v < base.positions.size(); ++v) {
    if (decoded.positions[coded.decoded_vertex[v]] != base.positions[v]) return false;
  }
  std::vector<Triangle> renamed = base.triangles;
  for (Triangle& t : renamed) {
    for (std::uint32_t& v : t) v = coded.decoded_vertex[v];
  }
  return sorted(std::move(renamed)) == sorted(decoded.triangles);
}

// Decodes what was just encoded.
Result<LatticeMesh> decode_own(const Bytes& bytes) {
  const auto mesh = decode(bytes);
  return mesh ? from_draco(**mesh) : mesh.error();
}

// Where Draco's decoder puts each vertex. Draco does not tell; but the order depends on the
// connectivity alone, so it is read off a mesh whose vertices lie at (their index, 0, 0). The
// caller checks that both meshes indeed came back in the same order.
Result<std::vector<std::uint32_t>> find_order(const LatticeMesh& base, int method) {
  std::vector<Vec3i> indices(base.positions.size());
  for (std::size_t v = 0; v < indices.size(); ++v) indices[v].x = static_cast<std::int32_t>(v);
  const Result<Bytes> bytes = encode(indices, base.triangles, method);
  if (!bytes) return bytes.error();
  const Result<LatticeMesh> decoded = decode_own(*bytes);
  if (!decoded) return decoded.error();
  std::vector<std::uint32_t> decoded_vertex(indices.size(), 0);
  for (std::uint32_t v = 0; v < decoded->positions.size(); ++v) {
    const auto index = static_cast<std::uint32_t>(decoded->positions[v].x);
    if (index < decoded_vertex.size()) decoded_vertex[index] = v;
  }
  return decoded_vertex;
}

Result<EncodedBase> encode_with(const LatticeMesh& base, int method) {
  EncodedBase coded;
  Result<std::vector<std::uint32_t>> order = find_order(base, method);
  if (!order) return order.error();
  coded.decoded_vertex = std::move(*order);
  Result<Bytes> bytes = encode(base.positions, base.triangles, method);
  if (!bytes) return bytes.error();
  coded.bytes = std::move(*bytes);
  Result<LatticeMesh> decoded = decode_own(coded.bytes);
  if (!decoded) return decoded.error();
  coded.decoded = std::move(*decoded);
  if (!is_renaming(base, coded)) return runtime_error("Draco: the base mesh came back changed");
  if (base.triangles.size() > kMaxBaseFacesPerByte * coded.bytes.size()) {
    return runtime_error("Draco: coded too well for a reader's limit");
  }
  return coded;
}

// Draco's own header and the counts that follow it (Draco bitstream specification, section 3).
class DracoHeader {
 public:
  explicit DracoHeader(ByteView bytes) : reader_(bytes) {}

  Status check(const MeshCounts& counts) {
    constexpr std::uint8_t kMesh = 1, kSequential = 0, kEdgeBreaker = 1;
    const ByteView magic = reader_.take(5);
    const auto major = reader_.get<std::uint8_t>(), minor = reader_.get<std::uint8_t>();
    const auto type = reader_.get<std::uint8_t>(), method = reader_.get<std::uint8_t>();
    const auto flags = reader_.get<std::uint16_t>();
    if (!std::equal(magic.begin(), magic.end(), as_bytes("DRACO").begin()) || major != 2 ||
        minor != 2 || type != kMesh || method > kEdgeBreaker || flags != 0) {
      return bad_input("not a Draco 2.2 mesh");
    }
    if (method == kEdgeBreaker) reader_.get<std::uint8_t>();  // traversal
    const std::uint64_t first = varint(), second = varint();
    const std::uint64_t faces = method == kSequential ? first : second;
    const std::uint64_t vertices = method == kSequential ? second : first;
    if (reader_.failed() || MeshCounts{vertices, faces} != counts) {
      return bad_input("Draco's counts differ from the header's");
    }
    return {};
  }

 private:
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const auto byte = reader_.get<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7Fu} << shift;
      if ((byte & 0x80) == 0) break;
    }
    return value;
  }

  ByteReader reader_;
};

}  // namespace

Result<EncodedBase> encode_base(const LatticeMesh& base) {
  try {
    Result<EncodedBase> coded = encode_with(base, draco::MESH_EDGEBREAKER_ENCODING);
    // Sequential coding keeps every order, at several times the bytes: it cannot go wrong.
    return coded ? std::move(coded) : encode_with(base, draco::MESH_SEQUENTIAL_ENCODING);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, "out of memory while encoding the base mesh"};
  }
}

Result<LatticeMesh> decode_base(ByteView bytes, const MeshCounts& counts) {
  if (Status status = DracoHeader(bytes).check(counts); !status) return status.error();
  try {
    const auto mesh = decode(bytes);
    if (!mesh) return mesh.error();
    return from_draco(**mesh);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, "out of memory while decoding the base mesh"};
  }
}

}  // namespace pmesh
