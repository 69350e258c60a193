#include "core/pm/base_codec.h"

#include <algorithm>
#include <memory>
#include <new>
#include <string>

#include <draco/attributes/point_attribute.h>
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

namespace pmesh {
namespace {

constexpr int kBestCompression = 0;  // Draco's "speed"

// An attribute of `components` 32-bit integers a vertex, point i being vertex i.
template <class T>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type,
                  const std::vector<T>& values) {
  draco::GeometryAttribute attribute;
  constexpr auto kComponents = static_cast<std::int8_t>(sizeof(T) / sizeof(std::int32_t));
  attribute.Init(type, nullptr, kComponents, data_type, false, sizeof(T), 0);
  const auto count = static_cast<draco::AttributeValueIndex::ValueType>(values.size());
  const int id = mesh.AddAttribute(attribute, true, count);
  for (draco::AttributeValueIndex i(0); i < count; ++i) {
    mesh.attribute(id)->SetAttributeValue(i, &values[i.value()]);
  }
  return id;
}

std::unique_ptr<draco::Mesh> to_draco(const LatticeMesh& base) {
  auto mesh = std::make_unique<draco::Mesh>();
  mesh->set_num_points(static_cast<std::uint32_t>(base.positions.size()));
  mesh->SetNumFaces(base.triangles.size());
  for (std::uint32_t f = 0; f < base.triangles.size(); ++f) {
    const auto [a, b, c] = base.triangles[f];
    mesh->SetFace(draco::FaceIndex(f),
                  {draco::PointIndex(a), draco::PointIndex(b), draco::PointIndex(c)});
  }
  add_attribute(*mesh, draco::GeometryAttribute::POSITION, draco::DT_INT32, base.positions);
  return mesh;
}

Result<Bytes> encode(const draco::Mesh& mesh, int method) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(kBestCompression, kBestCompression);
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeToBuffer(&buffer);
  if (!status.ok()) return runtime_error("Draco: " + status.error_msg_string());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

Result<std::unique_ptr<draco::Mesh>> decode(ByteView bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return bad_input("Draco: " + decoded.status().error_msg_string());
  return std::move(decoded).value();
}

// The values of an integer attribute by point.
template <class T>
Result<std::vector<T>> values_of(const draco::Mesh& mesh, const draco::PointAttribute* attribute) {
  constexpr int kComponents = sizeof(T) / sizeof(std::int32_t);
  if (attribute == nullptr || attribute->num_components() != kComponents ||
      (attribute->data_type() != draco::DT_INT32 && attribute->data_type() != draco::DT_UINT32)) {
    return bad_input("Draco: not " + std::to_string(kComponents) + " 32-bit integers a vertex");
  }
  std::vector<T> values(mesh.num_points());
  for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex index = attribute->mapped_index(p);
    if (index.value() >= attribute->size()) return bad_input("Draco: a vertex has no position");
    attribute->GetValue(index, &values[p.value()]);
  }
  return values;
}

Result<LatticeMesh> from_draco(const draco::Mesh& mesh) {
  auto positions =
      values_of<Vec3i>(mesh, mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION));
  if (!positions) return positions.error();
  LatticeMesh base;
  base.positions = std::move(*positions);
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

// Whether `decoded` is `base` with vertices renamed by decoded_vertex.
bool is_renaming(const LatticeMesh& base, const EncodedBase& coded) {
  const LatticeMesh& decoded = coded.decoded;
  if (decoded.positions.size() != base.positions.size() ||
      decoded.triangles.size() != base.triangles.size()) {
    return false;
  }
  std::vector<Triangle> expected, found;
  for (const auto [a, b, c] : base.triangles) {
    expected.push_back(
        normalised({coded.decoded_vertex[a], coded.decoded_vertex[b], coded.decoded_vertex[c]}));
  }
  for (const Triangle& t : decoded.triangles) found.push_back(normalised(t));
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  if (expected != found) return false;
  for (std::size_t v = 0; v < base.positions.size(); ++v) {
    if (decoded.positions[coded.decoded_vertex[v]] != base.positions[v]) return false;
  }
  return true;
}

// Where Draco's decoder puts each vertex. Draco does not tell, so a second encoding carries every
// vertex's index along as an attribute; the caller checks that both have the same order.
Result<std::vector<std::uint32_t>> find_order(const LatticeMesh& base, int method) {
  const auto mesh = to_draco(base);
  std::vector<std::uint32_t> indices(base.positions.size());
  for (std::uint32_t v = 0; v < indices.size(); ++v) indices[v] = v;
  add_attribute(*mesh, draco::GeometryAttribute::GENERIC, draco::DT_UINT32, indices);
  const Result<Bytes> bytes = encode(*mesh, method);
  if (!bytes) return bytes.error();
  const auto decoded = decode(*bytes);
  if (!decoded) return decoded.error();
  const auto carried = values_of<std::uint32_t>(
      **decoded, (*decoded)->GetNamedAttribute(draco::GeometryAttribute::GENERIC));
  if (!carried) return carried.error();
  std::vector<std::uint32_t> decoded_vertex(indices.size(), 0);
  for (std::uint32_t v = 0; v < carried->size(); ++v) {
    if ((*carried)[v] < decoded_vertex.size()) decoded_vertex[(*carried)[v]] = v;
  }
  return decoded_vertex;
}

Result<EncodedBase> encode_with(const LatticeMesh& base, int method) {
  EncodedBase coded;
  Result<Bytes> bytes = encode(*to_draco(base), method);
  if (!bytes) return bytes.error();
  coded.bytes = std::move(*bytes);
  const auto mesh = decode(coded.bytes);
  if (!mesh) return mesh.error();
  Result<LatticeMesh> decoded = from_draco(**mesh);
  if (!decoded) return decoded.error();
  coded.decoded = std::move(*decoded);
  Result<std::vector<std::uint32_t>> order = find_order(base, method);
  if (!order) return order.error();
  coded.decoded_vertex = std::move(*order);
  if (!is_renaming(base, coded)) return runtime_error("Draco: the base mesh came back changed");
  return coded;
}

// Draco's own header and the counts that follow it (Draco bitstream specification, section 3).
class DracoHeader {
 public:
  explicit DracoHeader(ByteView bytes) : reader_(bytes) {}

  Status check(const FileHeader& header) {
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
    if (reader_.failed() || faces != header.base_faces || vertices > header.base_vertices) {
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

Result<LatticeMesh> decode_base(ByteView bytes, const FileHeader& header) {
  if (Status status = DracoHeader(bytes).check(header); !status) return status.error();
  try {
    const auto mesh = decode(bytes);
    if (!mesh) return mesh.error();
    return from_draco(**mesh);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, "out of memory while decoding the base mesh"};
  }
}

}  // namespace pmesh
