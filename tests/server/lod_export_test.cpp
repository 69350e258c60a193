#include "server/lod/lod_export.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "core/io/export.h"
#include "tests/server/opened_mesh.h"

namespace pmesh {
namespace {

constexpr std::uint64_t kAnyFaces = 1'000'000;

LodRequest wish(const std::string& query) { return parse_wish(query).value(); }

/// The LOD as format_mesh() writes it after the whole file was decoded.
Bytes expected(const testing::OpenedMesh& opened, const LodFile& lod, ExportFormat format) {
  RefinableMesh mesh = opened.mesh()->decode(opened.index().chunks.size()).value();
  mesh.set_vertices(lod.vertices);
  EXPECT_EQ(mesh.face_count(), lod.faces);
  return format_mesh(format, mesh.snapshot(), opened.index().header.lattice).value();
}

TEST(LodExport, WritesWhatTheWholeFileGives) {
  const testing::OpenedMesh opened(testing::closed_shape());
  for (const char* query : {"", "faces=100", "vertices=99", "ratio=0.5", "bytes=3000"}) {
    SCOPED_TRACE(query);
    const auto lod = export_lod(*opened.mesh(), wish(query), LodFormat::ply, kAnyFaces);
    EXPECT_EQ(lod->bytes, expected(opened, *lod, ExportFormat::ply));
    EXPECT_TRUE(lod->reached);
  }
}

TEST(LodExport, WritesEveryFormat) {
  const testing::OpenedMesh opened(testing::closed_shape());
  for (const auto& [format, as] :
       {std::pair(LodFormat::glb, ExportFormat::glb),
        std::pair(LodFormat::glb_draco, ExportFormat::glb_draco),
        std::pair(LodFormat::ply, ExportFormat::ply), std::pair(LodFormat::obj, ExportFormat::obj),
        std::pair(LodFormat::drc, ExportFormat::drc)}) {
    const auto lod = export_lod(*opened.mesh(), wish("faces=500"), format, kAnyFaces);
    EXPECT_EQ(lod->bytes, expected(opened, *lod, as)) << format_name(format);
  }
}

TEST(LodExport, GivesTheBaseToAWishForLess) {
  const testing::OpenedMesh opened(testing::closed_shape());
  const auto lod = export_lod(*opened.mesh(), wish("faces=1"), LodFormat::glb, kAnyFaces);
  EXPECT_EQ(lod->faces, opened.index().header.base_faces);
  EXPECT_FALSE(lod->reached);
}

TEST(LodExport, RefusesMoreFacesThanTheLimit) {
  const testing::OpenedMesh opened(testing::closed_shape());
  EXPECT_TRUE(export_lod(*opened.mesh(), wish("faces=100"), LodFormat::glb, 100).ok());
  const auto refused = export_lod(*opened.mesh(), wish(""), LodFormat::glb, 100);
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
  EXPECT_EQ(refused.error().message,
            "the wish comes to 1280 faces; finished meshes are made of at most 100");
}

TEST(LodExport, RefusesChunksWithoutThoseBefore) {
  const testing::OpenedMesh opened(testing::closed_shape());
  ASSERT_GE(opened.index().chunks.size(), 2u);
  EXPECT_TRUE(export_lod(*opened.mesh(), wish("chunks=0-1"), LodFormat::ply, kAnyFaces).ok());
  const auto refused = export_lod(*opened.mesh(), wish("chunks=1-1"), LodFormat::ply, kAnyFaces);
  EXPECT_EQ(refused.error().code, ErrorCode::usage);
}

TEST(LodExport, FailsOnceTheFileWasChanged) {
  const testing::OpenedMesh opened(testing::closed_shape());
  std::filesystem::last_write_time(
      opened.path(), std::filesystem::file_time_type::min() + std::chrono::hours(24 * 365 * 200));
  const auto lod = export_lod(*opened.mesh(), wish("faces=100"), LodFormat::ply, kAnyFaces);
  ASSERT_FALSE(lod.ok());
  EXPECT_EQ(lod.error().code, ErrorCode::runtime);
}

/// Whether the canonical wish gives the very mesh that `query` does.
void expect_same_mesh(const testing::OpenedMesh& opened, const LodRequest& asked) {
  const auto resolution = resolve_lod(asked, opened.index(), kAnyFaces);
  const LodRequest canonical = canonical_wish(asked, *resolution, opened.index());
  const auto lod = export_lod(*opened.mesh(), asked, LodFormat::ply, kAnyFaces);
  EXPECT_EQ(export_lod(*opened.mesh(), canonical, LodFormat::ply, kAnyFaces)->bytes, lod->bytes)
      << to_query(asked) << " as " << to_query(canonical);
}

TEST(CanonicalWish, IsForTheSameMesh) {
  for (const EncodedShape& shape : {testing::closed_shape(), testing::open_shape()}) {
    const testing::OpenedMesh opened(shape);
    for (std::uint64_t count = 1; count < 2100; count += 97) {
      expect_same_mesh(opened, {.kind = WishKind::faces, .count = count});
      expect_same_mesh(opened, {.kind = WishKind::vertices, .count = count});
      expect_same_mesh(opened, {.kind = WishKind::bytes, .count = 4 * count});
    }
    for (const char* query : {"", "ratio=0.31", "ratio=0.77", "chunks=0-0"}) {
      expect_same_mesh(opened, wish(query));
    }
  }
}

TEST(CanonicalWish, IsTheSameForWishesThatComeToOneMesh) {
  const testing::OpenedMesh opened(testing::closed_shape());
  const auto canonical = [&](const std::string& query) {
    const auto resolution = resolve_lod(wish(query), opened.index(), kAnyFaces);
    return to_query(canonical_wish(wish(query), *resolution, opened.index()));
  };
  EXPECT_EQ(canonical("faces=500"), canonical("faces=501"));
  EXPECT_EQ(canonical("faces=500"), canonical("vertices=252"));
  EXPECT_EQ(canonical(""), canonical("ratio=1"));
  EXPECT_EQ(canonical(""), canonical("bytes=10000000"));
  EXPECT_NE(canonical("faces=500"), canonical("faces=502"));
}

}  // namespace
}  // namespace pmesh
