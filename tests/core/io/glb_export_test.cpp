#include "core/io/glb_export.h"

#include <bit>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/box.h"
#include "core/io/draco_export.h"
#include "core/io/single_precision.h"
#include "tests/core/io/lattice_meshes.h"

namespace pmesh {
namespace {

using Json = nlohmann::json;

struct Glb {
  Json json;
  Bytes buffer;
};

/// The two chunks of a file, whose lengths and paddings are checked.
Glb opened(const Bytes& bytes) {
  EXPECT_EQ(bytes.size() % 4, 0u);
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0x46546C67u);
  EXPECT_EQ(reader.get<std::uint32_t>(), 2u);
  EXPECT_EQ(reader.get<std::uint32_t>(), bytes.size());
  const auto json_bytes = reader.get<std::uint32_t>();
  EXPECT_EQ(json_bytes % 4, 0u);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0x4E4F534Au);
  const ByteView json = reader.take(json_bytes);
  const auto buffer_bytes = reader.get<std::uint32_t>();
  EXPECT_EQ(reader.get<std::uint32_t>(), 0x004E4942u);
  const ByteView buffer = reader.take(buffer_bytes);
  EXPECT_FALSE(reader.failed());
  EXPECT_EQ(reader.remaining(), 0u);
  return {Json::parse(json.begin(), json.end()), {buffer.begin(), buffer.end()}};
}

Glb opened(const LatticeMesh& mesh, const Lattice& lattice,
           GlbGeometry geometry = GlbGeometry::accessors) {
  return opened(format_glb(mesh, lattice, geometry).value());
}

ByteView bytes_of(const Glb& glb, int accessor) {
  const Json& view =
      glb.json["bufferViews"][glb.json["accessors"][accessor]["bufferView"].get<int>()];
  return ByteView(glb.buffer)
      .subspan(view.value("byteOffset", 0u), view["byteLength"].get<std::size_t>());
}

std::vector<Vec3<float>> positions_of(const Glb& glb) {
  ByteReader reader(bytes_of(glb, 0));
  std::vector<Vec3<float>> positions(glb.json["accessors"][0]["count"].get<std::size_t>());
  for (Vec3<float>& p : positions) {
    for (float* c : {&p.x, &p.y, &p.z}) *c = std::bit_cast<float>(reader.get<std::uint32_t>());
  }
  EXPECT_FALSE(reader.failed());
  return positions;
}

std::vector<Triangle> triangles_of(const Glb& glb) {
  const Json& accessor = glb.json["accessors"][1];
  const bool is_short = accessor["componentType"] == 5123;
  ByteReader reader(bytes_of(glb, 1));
  std::vector<Triangle> triangles(accessor["count"].get<std::size_t>() / 3);
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = is_short ? reader.get<std::uint16_t>() : reader.get<std::uint32_t>();
    }
  }
  EXPECT_FALSE(reader.failed());
  return triangles;
}

Vec3d vector_of(const Json& json) { return {json[0], json[1], json[2]}; }

/// Where the node puts a vertex.
Vec3d placed(const Json& node, Vec3<float> p) {
  const Vec3d scale = vector_of(node.value("scale", Json::array({1, 1, 1})));
  const Vec3d offset = vector_of(node.value("translation", Json::array({0, 0, 0})));
  return offset + Vec3d{scale.x * p.x, scale.y * p.y, scale.z * p.z};
}

LatticeShape sphere(int bits) { return on_lattice({"sphere", shapes::icosphere(3)}, bits); }

TEST(GlbExport, KeepsVerticesAndFacesInTheirOrder) {
  for (const shapes::Shape& shape : shapes::manifolds()) {
    SCOPED_TRACE(shape.name);
    const LatticeShape level = on_lattice(shape, 12);
    const Glb glb = opened(level.mesh, level.lattice);
    EXPECT_EQ(triangles_of(glb), level.mesh.triangles);
    const auto positions = positions_of(glb);
    ASSERT_EQ(positions.size(), level.mesh.positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
      EXPECT_EQ(positions[v], to_single(level.lattice.position(level.mesh.positions[v])));
    }
    EXPECT_FALSE(glb.json["nodes"][0].contains("scale"));
  }
}

TEST(GlbExport, SaysTheExactBox) {
  const LatticeShape shape = sphere(12);
  const Glb glb = opened(shape.mesh, shape.lattice);
  const std::vector<Vec3<float>> positions = positions_of(glb);
  const Box<float> box = bounding_box(std::span(std::as_const(positions)));
  const Vec3d low = vector_of(glb.json["accessors"][0]["min"]);
  const Vec3d high = vector_of(glb.json["accessors"][0]["max"]);
  EXPECT_EQ(low, (Vec3d{box.low.x, box.low.y, box.low.z}));
  EXPECT_EQ(high, (Vec3d{box.high.x, box.high.y, box.high.z}));
}

TEST(GlbExport, TheNodePutsInPlaceWhatFloatsCannotHold) {
  for (const int bits : {12, 20, 24}) {
    LatticeShape shape = sphere(bits);
    shape.lattice = {{5'000'000.1, -4e6, 0.3}, 1e-4, shape.lattice.bits};
    const Glb glb = opened(shape.mesh, shape.lattice);
    const auto positions = positions_of(glb);
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const Vec3d off = placed(glb.json["nodes"][0], positions[v]) -
                        shape.lattice.position(shape.mesh.positions[v]);
      EXPECT_LE(length(off), 1e-4 / 100);  // of doubles at 5,000 km: 1e-9
    }
  }
}

TEST(GlbExport, IndicesAreShortWhereTheyFit) {
  LatticeMesh mesh{{}, {{0, 1, 65534}}};
  mesh.positions.assign(65535, {1, 2, 3});
  EXPECT_EQ(opened(mesh, {{}, 1, 4}).json["accessors"][1]["componentType"], 5123);
  mesh.positions.push_back({});
  mesh.triangles = {{0, 1, 65535}};
  const Glb glb = opened(mesh, {{}, 1, 4});
  EXPECT_EQ(glb.json["accessors"][1]["componentType"], 5125);
  EXPECT_EQ(triangles_of(glb), mesh.triangles);
}

TEST(GlbExport, WritesOneFaceOnOnePoint) {
  const LatticeMesh mesh{{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}, {{0, 1, 2}}};
  for (const GlbGeometry geometry : {GlbGeometry::accessors, GlbGeometry::draco}) {
    const Json json = opened(mesh, {{}, 1, 4}, geometry).json;
    EXPECT_EQ(json["accessors"][0]["count"], 3);
    EXPECT_EQ(json["accessors"][1]["count"], 3);
  }
}

TEST(GlbExport, ShowsBothSidesOfAMattSurface) {
  const Json json = opened(sphere(8).mesh, sphere(8).lattice).json;
  EXPECT_EQ(json["materials"][0]["doubleSided"], true);
  EXPECT_EQ(json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 0);
}

TEST(GlbExport, DracoHoldsTheSameMesh) {
  const LatticeShape shape = sphere(12);
  const Glb plain = opened(shape.mesh, shape.lattice);
  const Glb coded = opened(shape.mesh, shape.lattice, GlbGeometry::draco);
  EXPECT_EQ(coded.json["extensionsRequired"], Json::array({"KHR_draco_mesh_compression"}));
  EXPECT_EQ(coded.json["accessors"][0]["min"], plain.json["accessors"][0]["min"]);
  EXPECT_EQ(coded.json["accessors"][0]["count"], plain.json["accessors"][0]["count"]);
  EXPECT_EQ(coded.json["accessors"][1]["count"], plain.json["accessors"][1]["count"]);
  const Bytes draco = export_draco(shape.mesh, shape.lattice, DracoNumbers::floats)->bytes;
  EXPECT_TRUE(std::equal(draco.begin(), draco.end(), coded.buffer.begin()));
  EXPECT_EQ(coded.json["bufferViews"][0]["byteLength"], draco.size());
}

}  // namespace
}  // namespace pmesh
